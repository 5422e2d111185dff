"""The live page: what the detector sees and says, in a browser; its thresholds changed while it runs.

The detector hands rows and, now and then, a picture to the ``Board``; the server shows the board to every viewer. No
viewer, however slow, is waited for.
"""
