#!/usr/bin/env Rscript
# Recomputes in plain R what report.md says, from the tables beside this file, and goes on with mixed models where the
# packages ordinal and lme4 are installed (Debian: apt install r-cran-ordinal r-cran-lme4):
#
#   Rscript analysis.R [FOLDER OF THE TABLES]
#
# It is yours: change it as the study needs.
arguments <- commandArgs(trailingOnly = FALSE)
script <- sub("^--file=", "", grep("^--file=", arguments, value = TRUE))
given <- commandArgs(trailingOnly = TRUE)
folder <- if (length(given)) given[1] else if (length(script)) dirname(script[1]) else "."
table_of <- function(name) read.csv(file.path(folder, name), stringsAsFactors = FALSE, encoding = "UTF-8")

answers <- table_of("answers.csv")
scores <- table_of("scores.csv")
ours <- table_of("group_comparisons.csv")
ours_paired <- table_of("condition_comparisons.csv")

# One row per session, item or score.
ratings <- subset(answers, rating == 1 & !is.na(value),
                  c(session, pseudonym, group, period, condition, task, attempt, form, item, value))
if (nrow(scores)) {
    names(scores)[names(scores) == "score"] <- "item"
    ratings <- rbind(ratings, scores[names(ratings)])
}
if (!nrow(ratings)) {
    cat("There are no ratings yet.\n")
    quit(status = 0)
}

# What was asked once per visit is a baseline where the same was asked under conditions, and in no comparison of groups.
under <- nzchar(ratings$condition) & !is.na(ratings$condition)
asked <- paste(ratings$form, ratings$item)
compared <- ratings[under | !asked %in% asked[under], ]
# Each person once: sessions of one person are not independent.
people <- aggregate(value ~ pseudonym + group + form + item, compared, mean)
exact_rank_p <- function(a, b) {
    if (requireNamespace("coin", quietly = TRUE)) {
        frame <- data.frame(y = c(a, b), g = factor(rep(c("a", "b"), c(length(a), length(b)))))
        return(as.numeric(coin::pvalue(coin::wilcox_test(y ~ g, frame, distribution = "exact"))))
    }
    suppressWarnings(wilcox.test(a, b)$p.value)  # the normal approximation where there are ties
}
tried <- function(value) tryCatch(value, error = function(reason) NA)

cat("== Groups: Welch, Mann-Whitney", if (requireNamespace("coin", quietly = TRUE)) "(exact, coin)" else "(without coin: not exact with ties)", "\n")
for (i in seq_len(nrow(ours))) {
    row <- ours[i, ]
    of <- function(group) people$value[people$form == row$form & people$item == row$item & people$group == group]
    a <- of(row$first)
    b <- of(row$second)
    welch <- tried(t.test(a, b)$p.value)
    rank <- tried(exact_rank_p(a, b))
    cat(sprintf("%-14s %-14s %s (%d) and %s (%d): Welch P %.4f (report: %.4f), Mann-Whitney P %.4f (report: %.4f)\n",
                row$form, row$item, row$first, length(a), row$second, length(b), welch, row$welch_p, rank, row$mann_whitney_p))
}
if (nrow(ours)) {
    cat("\n== Holm within each form\n")
    # A form's scores are a family of their own.
    family <- paste(ours$form, ifelse(ours$item %in% unique(scores$item), "scores", "items"))
    for (name in unique(family)) {
        of_form <- ours[family == name, ]
        adjusted <- p.adjust(of_form$mann_whitney_p, "holm")
        cat(name, ": largest difference from the report",
            format(max(c(0, abs(adjusted - of_form$mann_whitney_holm_p)), na.rm = TRUE), digits = 2), "\n")
    }
}

if (nrow(ours_paired)) {
    cat("\n== Conditions, by person: paired t\n")
    by_condition <- aggregate(value ~ pseudonym + condition + form + item, ratings, mean)
    for (i in seq_len(nrow(ours_paired))) {
        row <- ours_paired[i, ]
        of <- function(condition) by_condition[by_condition$form == row$form & by_condition$item == row$item &
                                                   by_condition$condition == condition, c("pseudonym", "value")]
        both <- merge(of(row$first), of(row$second), by = "pseudonym")
        cat(sprintf("%-14s %-14s %s and %s: P %.4f (report: %.4f), %d people\n", row$form, row$item, row$first, row$second,
                    tried(t.test(both$value.x, both$value.y, paired = TRUE)$p.value), row$paired_p, nrow(both)))
    }
}

# Repeated tasks: every session counts, with the person as a random effect. Learning is in `period`.
repeated <- subset(ratings, condition != "")
models <- unique(repeated[c("form", "item")])
for (i in seq_len(nrow(models))) {
    some <- merge(repeated, models[i, ])
    effects <- c(if (length(unique(some$condition)) > 1) "condition", if (length(unique(some$task)) > 1) "task",
                 if (length(unique(some$group)) > 1) "group", if (length(unique(some$period)) > 1) "period")
    if (!length(effects) || length(unique(some$pseudonym)) < 5 || length(unique(some$value)) < 2) next
    formula <- paste(paste(effects, collapse = " + "), "+ (1 | pseudonym)")
    cat("\n== Mixed model of", models$form[i], models$item[i], ":", formula, "\n")
    steps <- length(unique(some$value))
    if (steps > 2 && steps <= 7 && requireNamespace("ordinal", quietly = TRUE)) {
        some$answer <- factor(some$value, ordered = TRUE)
        print(tried(summary(ordinal::clmm(as.formula(paste("answer ~", formula)), some))))
    } else if (requireNamespace("lme4", quietly = TRUE)) {
        print(tried(summary(lme4::lmer(as.formula(paste("value ~", formula)), some))))
    } else {
        cat("not made: the packages ordinal and lme4 are not installed\n")
    }
}
