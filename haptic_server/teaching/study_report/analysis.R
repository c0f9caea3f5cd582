#!/usr/bin/env Rscript
# Goes on where report.md ends: reads the tables beside this file, and fits mixed models of repeated tasks where the
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

tried <- function(value) tryCatch(value, error = function(reason) NA)

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
