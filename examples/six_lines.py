"""The shortest use: an object comes closer, the network says once when to get out of its way."""

import lobula

movie = lobula.stimuli.looming(speed_cm_s=8)
net, alarm = lobula.Network(), False
for frame in movie.frames():
    before, alarm = alarm, net.step(frame).collision
    if alarm and not before:
        print(f"avoid at {frame.time_s:.2f} s, {movie.contact_s - frame.time_s:.2f} s before contact")
