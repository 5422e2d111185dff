"""Medulla: where looming and translation part; lateral inhibition and grouping for the LGMDs, EMDs for the LPTCs."""
