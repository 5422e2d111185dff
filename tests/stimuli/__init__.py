"""Tests of the synthetic movies."""
