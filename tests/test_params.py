"""Settings: their checks, their paths, where their values come from."""

import json
import math
import re
from dataclasses import dataclass, field, fields, is_dataclass, replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.errors import ParameterError
from lobula.model.network import NetworkParams
from lobula.params import Params, param, parse_setting, settings_hash, to_dict, walk, with_settings


@dataclass(frozen=True, kw_only=True)
class Inner(Params):
    """A small group."""

    sigma_px: float = param(2.0, "px", "a width", low=0.5, high=8, source="chosen")
    spans_px: tuple[int, ...] = param((1, 2), "px", "distances", low=1, high=9, source="chosen")


@dataclass(frozen=True, kw_only=True)
class Outer(Params):
    """A group with a group inside."""

    count: int = param(3, "", "how many", low=1, high=10, source="paper")
    enabled: bool = param(True, "", "on", source="chosen")
    reads: str = param("change", "", "which", choices=("change", "lamina"), source="chosen")
    inner: Inner = field(default_factory=Inner)


EVERY = [(path, owner, name) for path, owner, name in walk(NetworkParams())]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"count": 0}, "Outer.count = 0: must be int in [1, 10]"),
        ({"count": 11}, "Outer.count = 11: must be int in [1, 10]"),
        ({"count": 3.0}, "Outer.count = 3.0: must be int in [1, 10]"),
        ({"count": True}, "Outer.count = True: must be int in [1, 10]"),
        ({"enabled": 1}, "Outer.enabled = 1: must be bool"),
        ({"reads": "retina"}, "Outer.reads = 'retina': must be str one of change, lamina"),
        ({"reads": None}, "Outer.reads = None: must be str one of change, lamina"),
    ],
)
def test_golden_messages(given, message):
    with pytest.raises(ParameterError, match=f"^{re.escape(message)}$"):
        Outer(**given)


@pytest.mark.parametrize("bad", [0.4, 8.1, math.nan, math.inf, "2", None, True, 2j])
def test_numbers_outside_are_refused(bad):
    with pytest.raises(ParameterError, match=r"^Inner\.sigma_px = .*: must be float in \[0\.5, 8\] px$"):
        Inner(sigma_px=bad)


@pytest.mark.parametrize(
    "bad", [(), [], 3, "12", (0, 1), [1, 10], (1, 2.0), (1, math.nan), ("1",), np.ones((2, 2), int)]
)
def test_lists_are_checked_item_by_item(bad):
    with pytest.raises(ParameterError, match=r"^Inner\.spans_px = .*: must be (a list of )?int in \[1, 9\] px$"):
        Inner(spans_px=bad)


def test_ends_of_a_range_belong_to_it():
    assert (Inner(sigma_px=0.5).sigma_px, Inner(sigma_px=8).sigma_px) == (0.5, 8)
    assert Inner(spans_px=(1, 9, 9)).spans_px == (1, 9, 9)


PLAIN = [
    (Inner, "sigma_px", 2, 2.0),
    (Inner, "sigma_px", np.float64(2), 2.0),
    (Inner, "sigma_px", np.float32(2), 2.0),
    (Inner, "sigma_px", np.uint8(2), 2.0),
    (Inner, "sigma_px", np.array(2), 2.0),
    (Inner, "sigma_px", Fraction(4, 2), 2.0),
    (Inner, "spans_px", [1, 2], (1, 2)),
    (Inner, "spans_px", np.array([1, 2]), (1, 2)),
    (Inner, "spans_px", (np.int64(1), np.uint8(2)), (1, 2)),
    (Outer, "count", np.int32(3), 3),
    (Outer, "enabled", np.True_, True),
    (Outer, "reads", np.str_("change"), "change"),
]


@pytest.mark.parametrize(("group", "name", "given", "plain"), PLAIN)
def test_values_become_plain_ones_of_their_own_kind(group, name, given, plain):
    """However a value came, it is kept, hashed and written as the one kind its setting has."""
    settings = {name: given}
    for made in (group(**settings), replace(group(), **settings), with_settings(group(), settings, "a script")):
        kept = getattr(made, name)
        assert (kept, type(kept)) == (plain, type(plain))
        assert not isinstance(plain, tuple) or [type(item) for item in kept] == [int, int]
        assert settings_hash(made) == settings_hash(group(**{name: plain}))
        assert json.loads(json.dumps(to_dict(made))) == to_dict(made)


@pytest.mark.parametrize(
    ("name", "given"),
    [("count", np.float64(3)), ("count", np.True_), ("enabled", np.int64(1)), ("reads", np.str_("retina"))],
)
def test_plain_or_not_the_wrong_kind_is_refused(name, given):
    with pytest.raises(ParameterError, match=rf"^Outer\.{name} = .*: must be "):
        Outer(**{name: given})


def test_settings_cannot_be_changed_in_place_and_replace_checks_again():
    with pytest.raises(AttributeError):
        Outer().count = 4
    with pytest.raises(ParameterError, match=r"Outer\.count = 0"):
        replace(Outer(), count=0)


@pytest.mark.parametrize(("path", "owner", "name"), EVERY, ids=[path for path, _, _ in EVERY])
def test_every_setting_of_the_network_is_fenced(path, owner, name):
    """Each has a meaning and an origin, accepts its own value, and refuses NaN and what lies beyond its range."""
    about = type(owner).__dataclass_fields__[name].metadata
    value = getattr(owner, name)
    assert about["doc"]
    assert about["source"]
    assert replace(owner, **{name: value}) == owner
    where = re.escape(f"{type(owner).__name__}.{name} = ")
    listed = isinstance(value, tuple)
    if isinstance(value, bool) or about["choices"]:
        beyond = ["no such choice", math.nan]
    else:
        assert about["low"] < about["high"]
        beyond = [math.nan, about["low"] - 1, about["high"] + 1, "1"]
    for bad in beyond:
        with pytest.raises(ParameterError, match=where):
            replace(owner, **{name: (bad, *value[1:]) if listed else bad})


def test_paths_are_walked_in_the_order_of_declaration():
    assert [path for path, _, _ in walk(Outer())] == ["count", "enabled", "reads", "inner.sigma_px", "inner.spans_px"]
    assert [path for path, _, _ in walk(Inner(), "net.inner.")] == ["net.inner.sigma_px", "net.inner.spans_px"]


def test_walk_reaches_every_field():
    def leaves(params):
        for f in fields(params):
            value = getattr(params, f.name)
            if is_dataclass(value):
                yield from leaves(value)
            elif f.name != "origins":
                yield f.name

    assert [name for _, _, name in EVERY] == list(leaves(NetworkParams()))
    assert len({path for path, _, _ in EVERY}) == len(EVERY)


def test_to_dict_is_plain():
    assert to_dict(Outer()) == {
        "count": 3, "enabled": True, "reads": "change", "inner": {"sigma_px": 2.0, "spans_px": [1, 2]},
    }  # fmt: skip


def test_settings_there_and_back():
    changed = with_settings(Outer(), {"count": 5, "inner": {"spans_px": [3]}}, "a file")
    assert with_settings(Outer(), to_dict(changed), "again") == changed
    assert with_settings(NetworkParams(), to_dict(NetworkParams()), "again") == NetworkParams()


def test_with_settings_changes_only_what_is_named():
    base = Outer()
    changed = with_settings(base, {"inner": {"sigma_px": 3}}, "--set")
    assert changed == replace(base, inner=Inner(sigma_px=3.0))
    assert type(changed.inner.sigma_px) is float
    assert base == Outer()


def test_origins():
    changed = with_settings(with_settings(Outer(), {"count": 5}, "a file"), {"inner": {"sigma_px": 3}}, "--set")
    assert changed.source_of("count") == "a file"
    assert changed.source_of("enabled") == "chosen"
    assert changed.inner.source_of("sigma_px") == "--set"
    assert changed.inner.source_of("spans_px") == "chosen"
    assert changed == replace(Outer(), count=5, inner=Inner(sigma_px=3.0))  # where a value comes from is not the value


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"counts": 4}, "unknown setting counts: did you mean count?"),
        ({"inner": {"sigma": 4}}, "unknown setting inner.sigma: did you mean sigma_px?"),
        ({"en": 4}, "unknown setting en: did you mean enabled?"),
        ({"inner": {"sigma_px": "abc"}}, "inner.sigma_px = 'abc': must be float in [0.5, 8] px"),
        ({"zzz": 4}, "unknown setting zzz: known here are count, enabled, reads, inner"),
        ({"origins": {}}, "unknown setting origins"),
        ({"inner": 4}, "inner = 4: is a group of settings, such as inner.sigma_px"),
        ({"count": {"a": 1}}, "count = {'a': 1}: must be int in [1, 10]"),
        ({"inner": {"sigma_px": math.nan}}, "inner.sigma_px = nan: must be float in [0.5, 8] px"),
        ({"inner": {"spans_px": [1, 99]}}, "inner.spans_px = (1, 99): must be int in [1, 9] px"),
    ],
)
def test_settings_that_do_not_exist_or_do_not_fit(given, message):
    with pytest.raises(ParameterError, match=re.escape(message)):
        with_settings(Outer(), given, "a file")


def test_the_nearest_name_is_found_in_the_network():
    with pytest.raises(ParameterError, match=r"unknown setting lamina\.dog\.sigma_pix: did you mean sigma_px\?"):
        with_settings(NetworkParams(), {"lamina": {"dog": {"sigma_pix": 2}}}, "a file")


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("lamina.dog.sigma_px=2", {"lamina": {"dog": {"sigma_px": 2}}}),
        ("clock.repeats=false", {"clock": {"repeats": False}}),
        ("decision.neurons=lgmds", {"decision": {"neurons": "lgmds"}}),
        ('decision.neurons="lgmds"', {"decision": {"neurons": "lgmds"}}),
        (" a.b = -1e-3 ", {"a": {"b": -0.001}}),
        ("lptc.emd.spans_px=[1, 2, 3]", {"lptc": {"emd": {"spans_px": [1, 2, 3]}}}),
        ("a=b=c", {"a": "b=c"}),
    ],
)
def test_golden_parse(text, tree):
    assert parse_setting(text) == tree


@pytest.mark.parametrize("bad", ["", "sigma", "=2", "a.b=", " = ", "a.b= "])
def test_parse_refuses(bad):
    with pytest.raises(ParameterError, match=r"must be PATH=VALUE, such as lamina\.dog\.sigma_px=2"):
        parse_setting(bad)


def test_parsed_nan_is_refused_where_it_lands():
    with pytest.raises(ParameterError, match=r"^inner\.sigma_px = nan"):
        with_settings(Outer(), parse_setting("inner.sigma_px=NaN"), "--set")


def test_hash_is_twelve_hexadecimal_digits():
    assert re.fullmatch(r"[0-9a-f]{12}", settings_hash(Outer()))


def test_hash_knows_values_and_not_origins():
    again = with_settings(Outer(), to_dict(Outer()), "another file")
    assert settings_hash(again) == settings_hash(Outer())


@pytest.mark.parametrize(("path", "owner", "name"), EVERY, ids=[path for path, _, _ in EVERY])
def test_hash_changes_with_every_setting(path, owner, name):
    about, value = type(owner).__dataclass_fields__[name].metadata, getattr(owner, name)
    if isinstance(value, bool):
        other = not value
    elif about["choices"]:
        other = next(choice for choice in about["choices"] if choice != value)
    elif isinstance(value, tuple):
        other = (value[0] + 1, *value[1:])
    else:
        other = value + 1 if value + 1 <= about["high"] else (value + about["low"]) / 2
    tree = {name: other}
    for parent in reversed(path.split(".")[:-1]):
        tree = {parent: tree}
    assert settings_hash(with_settings(NetworkParams(), tree, "test")) != settings_hash(NetworkParams())


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.floats(0.5, 8), st.integers(1, 10), st.lists(st.integers(1, 9), min_size=1, max_size=4))
def test_any_valid_settings_survive_text(sigma_px, count, spans_px):
    """What ``config show`` prints can be given back with ``--set``."""
    changed = Outer()
    for text in (f"inner.sigma_px={sigma_px!r}", f"count={count}", f"inner.spans_px={spans_px}"):
        changed = with_settings(changed, parse_setting(text), "--set")
    assert changed == Outer(count=count, inner=Inner(sigma_px=sigma_px, spans_px=tuple(spans_px)))
