"""The figures to reach, one file for each group; each has ``figures(rounds, quick)``."""
