"""Nothing that a search looks at is held out from it: of the battery, of any set of labels, of the arena's seeds."""

from __future__ import annotations

from collections import defaultdict

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lobula.errors import ParameterError
from lobula.evaluate.labels import Label
from lobula.stimuli.battery import battery
from lobula.tuning.arena_task import arena_task
from lobula.tuning.battery_task import battery_cases, battery_split, family_of
from lobula.tuning.clips_task import FINAL, MOST_FOLDS, clip_splits, searched
from lobula.tuning.split import Split


def label(number, group, collision):
    return Label(
        file=f"{number}.mp4", contact_frame=9 if collision else None, uncertainty_frames=0, kind="k", group=group
    )


@st.composite
def labels(draw):
    """Clips of several groups, two of which at least have a collision."""
    drawn = draw(st.lists(st.tuples(st.integers(0, 8), st.booleans()), max_size=30))
    rows = [(0, True), (1, True), *drawn]
    return [label(i, f"camera {group}", collision) for i, (group, collision) in enumerate(rows)]


class TestSplit:
    def test_nothing_may_be_in_both_parts(self):
        with pytest.raises(ParameterError, match="b: must not be searched on and held out at once"):
            Split(("a", "b"), ("b", "c"))

    def test_there_must_be_something_to_search_on(self):
        with pytest.raises(ParameterError, match="nothing to search on"):
            Split((), ("a",))


class TestBattery:
    split = battery_split(battery_cases())

    def test_each_movie_is_in_one_part(self):
        names = [case.name for case in battery_cases()]
        assert sorted([*self.split.train, *self.split.held_out]) == sorted(names)
        assert (len(self.split.train), len(self.split.held_out)) == (50, 28)  # as docs/tuning.md says

    def test_bright_objects_that_come_or_recede_are_in_neither(self):
        left_out = {case.name for case in battery()} - {case.name for case in battery_cases()}
        assert left_out == {f"{kind}-bright-{v}cm_s" for kind in ("looming", "receding") for v in (4, 8, 12)}

    def test_each_kind_is_in_both_parts(self):
        kinds = defaultdict(set)
        for case in battery_cases():
            kinds[family_of(case)[0]].add(case.name in self.split.held_out)
        assert set(kinds) == {
            "looming", "receding", "translating", "angular", "still", "noise", "flicker", "flash"
        }  # fmt: skip
        assert all(parts == {True, False} for parts in kinds.values())

    def test_mirror_twins_stay_together(self):
        for part in (self.split.train, self.split.held_out):
            for name in part:
                twin = name.replace("_right", "_*").replace("_left", "_right").replace("_*", "_left")
                assert twin in part

    def test_the_rule_by_hand(self):
        held_out = [name for name in self.split.held_out if name.startswith(("looming", "flicker", "angular"))]
        assert held_out == [
            "looming-dark-8cm_s", "looming-blobs", "looming-2.5cm", "looming-high_contrast", "looming-fills_view",
            "angular-from_left-30deg", "angular-from_right-30deg", "flicker-3hz-10pct", "flicker-50hz-10pct",
        ]  # fmt: skip


class TestClips:
    @given(labels())
    def test_no_group_is_on_both_sides_of_a_search(self, rows):
        groups = {row.file: row.group for row in rows}
        splits = dict(clip_splits(rows, "labels"))
        final = splits.pop(FINAL)
        assert set(final.train) == set(groups)
        assert final.held_out == ()
        assert 2 <= len(splits) <= MOST_FOLDS
        for split in splits.values():
            assert not {groups[file] for file in split.train} & {groups[file] for file in split.held_out}
            assert sorted(split.train + split.held_out) == sorted(groups)
        held_out = [file for split in splits.values() for file in split.held_out]
        assert sorted(held_out) == sorted(groups)  # each clip once

    @given(labels(), st.randoms())
    def test_the_order_of_the_rows_does_not_matter(self, rows, random):
        shuffled = random.sample(rows, len(rows))
        plain, other = clip_splits(rows, "labels"), clip_splits(shuffled, "labels")
        assert {n: set(s.held_out) for n, s in plain.items()} == {n: set(s.held_out) for n, s in other.items()}

    def test_what_does_not_count_and_what_is_marked_as_test_is_left_out(self):
        def row(**more):
            return Label(**{"file": "x", "contact_frame": None, "uncertainty_frames": 0, "kind": "k", **more})

        assert searched([row(split="test"), row(split="TEST"), row(event="NEAR MISS"), row(confidence="low")]) == []
        assert len(searched([row(split="dev"), row()])) == 2


class TestArena:
    def test_no_seed_is_in_both_parts(self):
        with pytest.raises(ParameterError, match="seed 5, 4 robots: must not be searched on and held out"):
            arena_task([4, 5], [5, 6], 1.0, [4])

    @pytest.mark.parametrize(("seeds", "held_out"), [([7000], [1]), ([1], [7999]), (range(6999, 7001), [1])])
    def test_the_seeds_of_the_table_are_refused(self, seeds, held_out):
        with pytest.raises(ParameterError, match="must not be among 7000 to 7999, kept for tests"):
            arena_task(seeds, held_out)

    def test_every_seed_is_run_with_every_number_of_robots(self):
        task = arena_task([1, 2], [3], 0.5, [4, 7])
        assert task.runs["seed 2, 7 robots"] == (2, 7)
        assert task.splits["arena"].held_out == ("seed 3, 4 robots", "seed 3, 7 robots")
        assert task.length_s(task.splits["arena"].train) == 2 * (4 + 7) * 30

    @pytest.mark.parametrize("minutes", [0.0, -1.0, 2000.0, float("nan")])
    def test_minutes_out_of_range(self, minutes):
        with pytest.raises(ParameterError, match="simulated minutes: must be above 0 and at most 1000"):
            arena_task(minutes=minutes)
