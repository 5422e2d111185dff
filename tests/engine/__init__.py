"""Tests of the C core and of the public network.

``test_behaviour``, ``test_input``, ``test_blocks`` and ``test_state`` hold what must be true of either engine: every
test runs on both. ``test_parity`` compares the two, ``test_processor`` and ``test_core_resize`` ask what only the core
has, ``test_without_core`` what happens where there is none.
"""
