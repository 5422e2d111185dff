"""Your own clips, scored: label them in a CSV file, run the network, count hits and false alarms.

Here the clips are rendered first, so that it runs anywhere. docs/labels.md describes the file.
"""

import csv
import tempfile
from pathlib import Path

import lobula
from lobula.evaluate.clips import score_clips
from lobula.evaluate.labels import read_labels
from lobula.evaluate.scoring import ClipScore
from lobula.evaluate.summary import summarise
from lobula.report.grey_clip import write_grey_clip

MOVIES = {
    "comes.mp4": lobula.stimuli.looming(scene="arena"),
    "comes_fast.mp4": lobula.stimuli.looming(scene="arena", speed_cm_s=12),
    "passes.mp4": lobula.stimuli.translating(scene="arena"),
    "goes.mp4": lobula.stimuli.receding(scene="arena"),
}

with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    with (folder / "labels.csv").open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["file", "collision", "contact_frame", "contact_uncertainty_frames", "class"])
        for clip, movie in MOVIES.items():
            write_grey_clip(folder / clip, movie.images, movie.times_s, movie.rate_hz)
            contact = "" if movie.contact_s is None else round(movie.contact_s * movie.rate_hz)
            rows.writerow([clip, int(movie.contact_s is not None), contact, 1, movie.kind])

    scores = []
    for result in score_clips(read_labels(folder / "labels.csv"), folder, lobula.Network):
        if isinstance(result, ClipScore):
            scores.append(result)
            says = "no hit" if result.lead_s is None else f"hit {result.lead_s:.2f} s before contact"
            print(
                f"{result.label.file:15} {says if result.label.collision else 'nothing comes'}, "
                f"{result.false_alarms} false alarms"
            )
        else:
            print(f"{result.label.file}: {result.message}")

total = summarise(scores).headline
print(f"hits {total.hits} of {total.collisions}, false alarms {total.false_alarms} in {60 * total.minutes:.1f} s")
