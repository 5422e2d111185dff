"""Many frames, or many streams, in one call: the fast way, with the same numbers as frame by frame."""

import numpy as np

import lobula

FRAMES = 100

comes = lobula.stimuli.looming(scene="arena")
passes = lobula.stimuli.translating(scene="arena")

net = lobula.Network()
trace = net.run(comes.images[:FRAMES], comes.times_s[:FRAMES])  # (T, H, W) -> a table of T readings
more = net.run(comes.images[FRAMES:], comes.times_s[FRAMES:])  # goes on where the block before ended
alarm = np.concatenate([trace, more])["collision"]
print(f"one stream of {len(alarm)} frames: first alarm in frame {alarm.argmax()}")

both = np.stack([comes.images[:124], passes.images[:124]])  # (S, T, H, W): two streams that know nothing of each other
table = lobula.Network().run(both, comes.times_s[:124], threads=2)
for name, stream in zip(("comes", "passes"), table, strict=True):
    print(
        f"{name}: {stream['spikes_lgmd1'].sum()} spikes of LGMD-1, {stream['spikes_lptc_r'].sum()} of LPTC-R, "
        f"alarm: {bool(stream['collision'].any())}"
    )
