#!/usr/bin/env Rscript
# Writes the values that tests/unit/haptic_server/teaching/study_statistics compares with, as R and its packages compute them:
#
#   tests/support/study_r_values.R >tests/unit/haptic_server/teaching/study_statistics/r_values.txt
#
# It needs r-base-core, r-cran-coin, r-cran-exactranktests and r-cran-boot (deploy/packages-bench.txt). One line is a
# name, then its numbers with all their digits.
suppressPackageStartupMessages({
    library(coin)
    library(boot)
})
suppressWarnings(suppressPackageStartupMessages(library(exactRankTests)))

put <- function(name, values) cat(name, sprintf("%.17g", as.numeric(values)), "\n")

set.seed(2011, kind = "Mersenne-Twister", normal.kind = "Inversion", sample.kind = "Rejection")
likert <- function(n, centre) pmin(5, pmax(1, round(rnorm(n, centre, 1))))
pairs <- list(
    likert_13_8 = list(likert(13, 4.0), likert(8, 3.2)),
    likert_13_8_alike = list(likert(13, 3.6), likert(8, 3.6)),
    normal_13_8 = list(rnorm(13, 1, 2), rnorm(8)),
    normal_5_7 = list(rnorm(5), rnorm(7, 0.5, 3)),
    likert_30_25 = list(likert(30, 3.5), likert(25, 3.1)),
    apart_4_3 = list(c(5, 5, 4, 5), c(1, 2, 2)),
    smallest_2_2 = list(c(1, 2), c(2, 4)),
    likert_70_60 = list(likert(70, 3.4), likert(60, 3.1))
)

for (name in names(pairs)) {
    a <- pairs[[name]][[1]]
    b <- pairs[[name]][[2]]
    put(paste0(name, ".a"), a)
    put(paste0(name, ".b"), b)
    test <- t.test(a, b)
    put(paste0(name, ".welch"), c(test$statistic, test$parameter, test$p.value, test$conf.int))

    u <- sum(outer(a, b, ">")) + sum(outer(a, b, "==")) / 2
    frame <- data.frame(y = c(a, b), g = factor(rep(c("a", "b"), c(length(a), length(b)))))
    if (length(a) + length(b) <= 100) {
        p <- sapply(c("two.sided", "less", "greater"), function(side)
            pvalue(coin::wilcox_test(y ~ g, frame, distribution = "exact", alternative = side)))
        one_sided <- sapply(c("less", "greater"), function(side) wilcox.exact(a, b, alternative = side)$p.value)
        stopifnot(all.equal(unname(p[2:3]), unname(one_sided), tolerance = 1e-9))
    } else {
        p <- sapply(c("two.sided", "less", "greater"), function(side)
            pvalue(coin::wilcox_test(y ~ g, frame, distribution = "asymptotic", alternative = side)))
    }
    put(paste0(name, ".mann_whitney"), c(u, p))

    n <- length(a)
    m <- length(b)
    pooled <- sqrt(((n - 1) * var(a) + (m - 1) * var(b)) / (n + m - 2))
    d <- (mean(a) - mean(b)) / pooled
    put(paste0(name, ".effects"), c(d, d * (1 - 3 / (4 * (n + m) - 9)), mean(sign(outer(a, b, "-"))), u / (n * m)))
}

paired <- list(
    likert_12 = list(likert(12, 3.8), likert(12, 3.1)),
    normal_9 = list(rnorm(9, 0.7), rnorm(9)),
    likert_120 = list(likert(120, 3.4), likert(120, 3.2))
)
for (name in names(paired)) {
    a <- paired[[name]][[1]]
    b <- paired[[name]][[2]]
    put(paste0(name, ".a"), a)
    put(paste0(name, ".b"), b)
    test <- t.test(a, b, paired = TRUE)
    put(paste0(name, ".paired_t"), c(test$statistic, test$parameter, test$p.value, test$conf.int))
    d <- a - b
    w <- sum(rank(abs(d))[d > 0])
    how <- if (sum(d != 0) <= 100) "exact" else "asymptotic"
    p <- sapply(c("two.sided", "less", "greater"), function(side)
        pvalue(wilcoxsign_test(a ~ b, distribution = how, zero.method = "Pratt", alternative = side)))
    put(paste0(name, ".pratt"), c(w, p))
}

# An interval from replicates, with boot's own BCa. The influence is the jackknife's over the group's size.
a <- rexp(14)
b <- rexp(11, 1.5)
both <- data.frame(y = c(a, b), g = rep(1:2, c(14, 11)))
difference <- function(data, rows) {
    drawn <- data[rows, ]
    mean(drawn$y[drawn$g == 1]) - mean(drawn$y[drawn$g == 2])
}
drawn <- boot(both, difference, R = 499, strata = both$g)
leave_out <- function(values, sign) {
    means <- sapply(seq_along(values), function(i) sign * mean(values[-i]))
    (length(values) - 1) * (mean(means) - means) / length(values)
}
influence <- c(leave_out(a, 1), leave_out(b, -1))
for (level in c(0.9, 0.95))
    put(paste0("bca.interval_", 100 * level), boot.ci(drawn, level, type = "bca", L = influence)$bca[4:5])
put("bca.replicates", drawn$t)
put("bca.observed", drawn$t0)
put("bca.influence", influence)

p <- round(runif(16), 3)
p[4] <- p[9]
p[2] <- 0.002
put("holm.p", p)
put("holm.adjusted", p.adjust(p, "holm"))
put("false_alarm_16", 1 - 0.95^16)

power_of <- function(d, n1, n2, alpha = 0.05) {
    df <- n1 + n2 - 2
    limit <- qt(1 - alpha / 2, df)
    shift <- d * sqrt(n1 * n2 / (n1 + n2))
    pt(limit, df, shift, lower.tail = FALSE) + pt(-limit, df, shift)
}
stopifnot(all.equal(power_of(0.8, 20, 20), power.t.test(20, 0.8, strict = TRUE)$power, tolerance = 1e-9))
for (d in c(0, 0.5, 1.35, 3)) put(paste0("power.d_", d), power_of(d, 13, 8))
put("power.smallest_13_8", uniroot(function(d) power_of(d, 13, 8) - 0.8, c(0.1, 5), tol = 1e-13)$root)
put("power.smallest_30_30", uniroot(function(d) power_of(d, 30, 30) - 0.9, c(0.1, 5), tol = 1e-13)$root)
put("power.smallest_13_8_holm", uniroot(function(d) power_of(d, 13, 8, 0.05 / 16) - 0.8, c(0.1, 5), tol = 1e-13)$root)
put("power.needed_half", ceiling(power.t.test(delta = 0.5, power = 0.8, strict = TRUE)$n))

# What the thesis prints: P = .04 of 13 and 8 people, and the shares of page 65.
implied <- qt(1 - 0.04 / 2, 19) * sqrt(1 / 13 + 1 / 8)
root <- function(share) uniroot(function(d)
    pt(implied * sqrt(104 / 21), 19, d * sqrt(104 / 21), lower.tail = FALSE) - share, c(-5, 8), tol = 1e-13)$root
put("thesis.implied_d", c(implied, root(0.025), root(0.975)))
for (share in list(c(13, 21), c(11, 13), c(10, 13), c(5, 8), c(1, 21), c(0, 8), c(8, 8)))
    put(paste0("wilson.", share[1], "_", share[2]),
        suppressWarnings(prop.test(share[1], share[2], correct = FALSE)$conf.int))

leaning <- rnorm(21, sd = 0.8)
block <- sapply(1:6, function(i) pmin(5, pmax(1, round(3.5 + leaning + rnorm(21, sd = 0.7)))))
put("alpha.values", t(block))
covariance <- cov(block)
put("alpha.alpha", 6 / 5 * (1 - sum(diag(covariance)) / sum(covariance)))

rated <- data.frame(thing = factor(rep(1:10, 3)), rater = factor(rep(1:3, each = 10)))
rated$y <- round(rep(rnorm(10, 60, 15), 3) + rep(c(0, 4, -3), each = 10) + rnorm(30, sd = 5))
squares <- anova(lm(y ~ thing + rater, rated))[["Mean Sq"]]
put("icc.values", t(matrix(rated$y, 10)))
put("icc.icc", (squares[1] - squares[3]) / (squares[1] + 2 * squares[3] + 3 * (squares[2] - squares[3]) / 10))

first <- sample(1:4, 25, TRUE)
second <- pmin(4, pmax(1, first + sample(-1:1, 25, TRUE, c(0.2, 0.6, 0.2))))
shares <- table(factor(first, 1:4), factor(second, 1:4)) / 25
by_chance <- outer(rowSums(shares), colSums(shares))
apart <- outer(1:4, 1:4, "-")^2
put("kappa.first", first)
put("kappa.second", second)
put("kappa.plain", (sum(diag(shares)) - sum(diag(by_chance))) / (1 - sum(diag(by_chance))))
put("kappa.quadratic", 1 - sum(apart * shares) / sum(apart * by_chance))
