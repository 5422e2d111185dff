"""The paper's experiments, one file per figure or table, and what they share: courses, trials, claims, pages."""
