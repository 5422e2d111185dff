"""Tests of the model, layer by layer, in the same tree; the slow versions they are held against lie in oracles."""
