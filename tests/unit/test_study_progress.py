"""How far a study is: reported to a function in the caller's thread, or shown as a bar."""

import io
import sys
import threading

import pytest

import rockflex as rf
from builders import frame_values
from rockflex import InputError
from rockflex.studies.progress import MAX_INTERVAL, MIN_INTERVAL, ProgressLogLines, progress_bar

FRAME = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
HELD = rf.Restrained(FRAME, rf.Tendon(initial_force=300e3, stiffness=2e6))
PULSE = rf.one_sine_pulse(amplitude=3.0, period=0.8)
SCALES = [0.2 + 0.01 * step for step in range(100)]
SEARCH = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0], refinements=1)
COST = rf.DesignCost(half_width=1.0, prestress=5e-7)
STUDY = rf.CloudStudy(
    structures=[{"name": "A", "frame": frame_values(n_stories=2, period=0.5, aspect_ratio=8.0)}],
    records={"suites": ["el-centro-1940"]},
    scales=[0.5, 1.0, 1.5],
    runs_per_chunk=1,
)

CALLS = {
    "simulate_many": (lambda **how: rf.simulate_many(FRAME, PULSE, "2DOF-S", scales=SCALES, **how), 100),
    "simulate_many of many": (lambda **how: rf.simulate_many([FRAME] * 150, PULSE, "2DOF-S", **how), 150),
    "run_cloud": (lambda **how: rf.run_cloud(FRAME, PULSE, "2DOF-S", scales=SCALES, **how), 100),
    "run_cloud of many": (lambda **how: rf.run_cloud([FRAME] * 150, PULSE, "2DOF-S", scales=[0.5, 1.0], **how), 300),
    "run_incremental": (
        lambda **how: rf.run_incremental([FRAME] * 3, PULSE, "2DOF-S", growth=1.5, tolerance=0.05, **how),
        3,
    ),
    "run_design": (lambda **how: rf.run_design(FRAME, PULSE, [1.0, 1.5], models="2DOF-S", **how), 2),
    "search_design": (
        lambda **how: rf.search_design(
            HELD, PULSE, SEARCH, [rf.Requirement(0.01, 0.2, at=2.0)], COST, "2DOF-S", scales=[0.5, 1.0, 2.0, 4.0], **how
        ),
        SEARCH.n_designs,
    ),
    "run_population": (lambda **how: rf.run_population(rf.load_suite("el-centro-1940"), pairs=3, seed=1, **how), 3),
    "rocking_spectrum": (lambda **how: rf.rocking_spectrum(PULSE, [0.2, 0.3], [2.0, 4.0], **how), 4),
    "overturning_spectrum": (
        lambda **how: rf.overturning_spectrum(
            rf.rigid_block(0.2, 2.0), rf.one_sine_pulse, [3.0, 4.0, 5.0], relative_amplitudes=(1.0, 10.0), **how
        ),
        3,
    ),
}
each_call = pytest.mark.parametrize("name", CALLS)


@pytest.mark.slow
@each_call
@pytest.mark.parametrize("workers", [1, 2])
def test_a_function_is_told_from_nothing_to_everything(name, workers):
    call, total = CALLS[name]
    written: list[tuple[int, int]] = []
    threads = set()

    def tell(done: int, of: int) -> None:
        written.append((done, of))
        threads.add(threading.current_thread())

    call(workers=workers, progress=tell)
    done = [each for each, _ in written]
    assert written[0] == (0, total)
    assert written[-1] == (total, total)
    assert done == sorted(set(done))
    assert {of for _, of in written} == {total}
    assert threads == {threading.main_thread()}


@each_call
def test_what_a_function_raises_ends_the_study(name):
    call, _ = CALLS[name]

    def tell(done: int, _: int) -> None:
        if done:
            raise KeyError("enough")

    before = threading.active_count()
    with pytest.raises(KeyError, match="enough") as raised:
        call(workers=2, progress=tell)
    assert threading.active_count() == before  # none goes on, although the error keeps what was being done
    assert raised.value.args == ("enough",)


@each_call
def test_anything_else_is_refused(name):
    with pytest.raises(InputError, match=r'^progress must be None, "bar" or a function of \(done, total\), but'):
        CALLS[name][0](progress="dots")


def test_a_study_refuses_anything_else_before_it_makes_a_folder(tmp_path):
    for call in (rf.run_study, rf.fill_study):
        with pytest.raises(InputError, match=r"or a function of one Progress, but 3 was given\."):
            call(STUDY, tmp_path / "new", progress=3)
    assert not (tmp_path / "new").exists()


class Terminal(io.StringIO):
    """A stderr that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def test_a_bar_is_drawn_in_a_terminal(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.setattr(sys, "stderr", Terminal())
    with progress_bar("Runs") as show:
        show(0, 400, "")
        show(100, 400, "7 rows/s")
        show(400, 400, "")
    text = sys.stderr.getvalue()
    assert "Runs" in text
    assert "400/400" in text


def test_the_time_left_is_that_of_the_whole_time(monkeypatch):
    """Parts that end in bursts, far apart, after some that an earlier call had stored."""
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.setattr(sys, "stderr", Terminal())
    now = iter([0.0, 0.0, 300.0, 300.0, 300.0, 300.0, 600.0, 600.0])
    monkeypatch.setattr("rockflex.studies.progress.perf_counter", lambda: next(now))
    with progress_bar("Parts") as show:
        show(50, 100, "")
        for done in (51, 52, 53, 54, 60):
            show(done, 100, "")
        show(60, 100, "")
    # 10 parts in 600 s, and 40 are to come.
    assert "40 min left" in sys.stderr.getvalue()


def test_the_results_are_those_without_a_bar(monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    plain = rf.run_cloud(FRAME, PULSE, "2DOF-S", scales=SCALES)
    assert rf.run_cloud(FRAME, PULSE, "2DOF-S", scales=SCALES, progress="bar").equals(plain)
    assert rf.run_study(STUDY, progress="bar").equals(rf.run_study(STUDY))
    assert "100/100" in sys.stderr.getvalue()


def lines_of(capsys: pytest.CaptureFixture[str], done: list[tuple[float, int]], *, last: bool = False) -> list[str]:
    """The lines of a study of 200 parts that reports what is done at these times in s."""
    now = [0.0]
    lines = ProgressLogLines("cloud", last=last, clock=lambda: now[0])
    for time, parts in done:
        now[0] = time
        lines.show(parts, 200)
    return capsys.readouterr().err.splitlines()


def test_a_log_gets_a_line_after_half_a_minute_and_a_tenth_more(capsys):
    assert lines_of(
        capsys,
        [(0.0, 0), (MIN_INTERVAL - 1, 100), (MIN_INTERVAL + 1, 110), (MIN_INTERVAL + 20, 140), (2 * MIN_INTERVAL, 142)],
    ) == ["cloud: 110 of 200 (55 %), 31 s elapsed, about 25 s left"]
    assert lines_of(
        capsys,
        [
            (0.0, 0),
            (MIN_INTERVAL, 19),
            (MAX_INTERVAL - 1, 19),
            (MAX_INTERVAL, 19),
            (2 * MAX_INTERVAL - 1, 38),
            (2 * MAX_INTERVAL, 39),
        ],
    ) == [
        "cloud: 19 of 200 (9 %), 10 min elapsed, about 1.6 h left",
        "cloud: 39 of 200 (19 %), 20 min elapsed, about 83 min left",
    ]


def test_time_left_counts_only_what_this_call_did(capsys):
    assert lines_of(capsys, [(0.0, 100), (50.0, 150)]) == ["cloud: 150 of 200 (75 %), 50 s elapsed, about 50 s left"]


def test_a_short_study_says_nothing_unless_a_last_line_is_asked_for(capsys):
    assert lines_of(capsys, [(0.0, 0), (5.0, 200)]) == []
    assert lines_of(capsys, [(0.0, 0), (5.0, 200)], last=True) == ["cloud: 200 of 200 (100 %), 5.0 s elapsed"]


def test_a_bar_that_nobody_sees_is_lines(capsys):
    rf.run_cloud(FRAME, PULSE, "2DOF-S", scales=SCALES, progress="bar")
    assert capsys.readouterr().err.startswith("Runs: 100 of 100 (100 %)")
