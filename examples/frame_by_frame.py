"""A camera, a clip, a folder of images or, without an argument, a synthetic movie: one loop for all of them.

python examples/frame_by_frame.py 0            the first camera
python examples/frame_by_frame.py clip.mp4
python examples/frame_by_frame.py
"""

import sys

import lobula


def main(source: object) -> None:
    net = lobula.Network()
    was = False
    with lobula.open(source) as frames:
        print(f"{frames.name}: {frames.width} x {frames.height} px, {'live' if frames.live else 'recorded'}")
        for frame in frames:
            reading = net.step(frame)
            if reading.collision != was:
                was = reading.collision
                print(f"{reading.time_s:7.3f} s  {'COLLISION' if was else 'over'}  {reading.spikes}")
        print(f"{frames.dropped} frames dropped")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else lobula.stimuli.looming(scene="arena"))
