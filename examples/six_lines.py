"""The shortest use: an object comes closer, the network says when to get out of its way."""

import lobula

movie = lobula.stimuli.looming(speed_cm_s=8)
net = lobula.Network()
for frame in movie.frames():
    reading = net.step(frame)
    if reading.collision:
        print(f"avoid at {reading.time_s:.2f} s, {movie.contact_s - reading.time_s:.2f} s before contact")
        break
