"""Every layer can be looked at: ask for maps by name and get them with the reading."""

import sys

import lobula

WANTED = ("change", "lamina", "lgmd1_grouped", "lgmd2_grouped", "motion")

movie = lobula.stimuli.translating(scene="arena", direction="right")
net = lobula.Network()
for frame in movie.frames():
    reading = net.step(frame, taps=WANTED if frame.time_s > 2 else ())
    if reading.taps:
        break

for name, image in reading.taps.items():
    rows, columns = image.shape
    print(f"{name:14} {rows} x {columns}, {image.min():10.4f} .. {image.max():9.4f}")
print(f"net motion is {'rightward' if reading.taps['motion'].sum() > 0 else 'leftward'}, LPTC-R = {reading.lptc_r:.2f}")

if len(sys.argv) > 1:  # python examples/look_inside.py maps.png
    from lobula.report.montage import Tile, map_picture, montage
    from lobula.report.png import write_png

    write_png(sys.argv[1], montage([Tile(map_picture(image), name) for name, image in reading.taps.items()], columns=3))
