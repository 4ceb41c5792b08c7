"""A map over a Dask cluster of real processes: the same tables, whatever dies on the way."""

import builtins
import functools
import socket
import time
from pathlib import Path

import distributed
import pandas as pd
import pytest

import another_package
from dask_cluster import Cluster
from rockflex import InputError
from rockflex.studies import _dask_worker, parallel
from rockflex.studies.folders import StudyFolder
from rockflex.studies.parallel import ClusterError, map_chunks_on_dask
from toy_study import DeadlyPlan, FailingPlan, FlakyPlan, ToyPlan, run_study

pytestmark = pytest.mark.slow


def parts(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in (folder / "parts").iterdir()}


def test_the_parts_are_those_of_a_local_study_to_the_last_bit(tmp_path: Path, cluster: Cluster) -> None:
    plan = ToyPlan(n_chunks=12, ballast=bytes(12_000_000))  # more than Dask takes in a graph without a warning
    here, there = tmp_path / "here", tmp_path / "there"
    run_study(str(here), plan)
    assert sorted(run_study(str(there), plan, cluster.address)) == list(range(12))
    assert parts(here) == parts(there)
    pd.testing.assert_frame_equal(StudyFolder.load(there).frame(), plan.whole())


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, ...]]:
    """The batches of chunks that were sent as tasks."""
    found: list[tuple[int, ...]] = []
    real = distributed.Client.submit

    def submit(
        self: distributed.Client, function: object, name: str, batch: tuple[int, ...], *rest: object, **options: object
    ):
        found.append(batch)
        return real(self, function, name, batch, *rest, **options)

    monkeypatch.setattr(distributed.Client, "submit", submit)
    return found


def test_few_tasks_are_in_flight(cluster: Cluster, sent: list[tuple[int, ...]]) -> None:
    came: set[int] = set()
    for number, _ in map_chunks_on_dask(ToyPlan(delay=0.02), range(20), cluster.address):
        came.add(number)
        assert sum(not came.issuperset(batch) for batch in sent) <= 4 + 1  # two for each of two threads, and this one
    assert [number for batch in sent for number in batch] == list(range(20))


def test_short_chunks_share_a_task(cluster: Cluster, sent: list[tuple[int, ...]]) -> None:
    asked = [number for number in range(600) if number % 3]  # what is missing in a folder has gaps
    found = dict(map_chunks_on_dask(ToyPlan(rows=3), asked, cluster.address))
    assert sorted(found) == asked
    assert found[500].to_pandas().equals(ToyPlan(rows=3).frame(500))
    assert [number for batch in sent for number in batch] == asked
    assert [len(batch) for batch in sent[:4]] == [1, 1, 1, 1]  # nothing is known of their time yet
    assert len(sent) < 60
    assert max(map(len, sent)) > 20
    assert len(sent[-1]) <= 2  # all threads finish together


def test_an_error_within_a_task_names_its_chunk(
    cluster: Cluster, monkeypatch: pytest.MonkeyPatch, sent: list[tuple[int, ...]]
) -> None:
    monkeypatch.setattr(parallel, "chunks_per_task", lambda left, threads, chunk_time: 4)
    with pytest.raises(ArithmeticError, match="chunk 2 is beyond repair") as caught:
        list(map_chunks_on_dask(FailingPlan(), range(8), cluster.address, retries=0))
    assert sent == [(0, 1, 2, 3), (4, 5, 6, 7)]
    assert "raised by chunk 2 on a worker" in caught.value.__notes__[0]


def test_nothing_asked_is_nothing_done() -> None:
    assert list(map_chunks_on_dask(ToyPlan(), [], "nowhere")) == []


def test_the_first_chunk_that_raises_ends_the_map_with_its_number(cluster: Cluster) -> None:
    with pytest.raises(ArithmeticError, match="chunk 2 is beyond repair") as caught:
        list(map_chunks_on_dask(FailingPlan(), range(4), cluster.address, retries=1))
    assert "raised by chunk 2 on a worker" in caught.value.__notes__[0]


def test_a_chunk_that_raises_is_tried_again(tmp_path: Path, cluster: Cluster) -> None:
    plan = FlakyPlan(folder=str(tmp_path))
    with pytest.raises(OSError, match="the network is down") as caught:  # and not the scheduler's
        list(map_chunks_on_dask(plan, [0], cluster.address, retries=0))
    assert "raised by chunk 0" in caught.value.__notes__[0]
    assert {number for number, _ in map_chunks_on_dask(plan, range(6), cluster.address, retries=1)} == set(range(6))


def test_a_consumer_that_stops_frees_the_cluster(cluster: Cluster) -> None:
    results = map_chunks_on_dask(ToyPlan(n_chunks=100, delay=0.2), range(100), cluster.address)
    next(results)
    results.close()
    with distributed.Client(cluster.address, set_as_default=False) as client:
        there = client.run(lambda dask_worker: [name for name in dask_worker.plugins if name.startswith("rockflex")])
    assert list(there.values()) == [[], []]
    begin = time.monotonic()
    assert len(list(map_chunks_on_dask(ToyPlan(), range(2), cluster.address))) == 2
    assert time.monotonic() - begin < 5.0


def test_a_plan_that_workers_cannot_load_is_refused(cluster: Cluster, monkeypatch: pytest.MonkeyPatch) -> None:
    class Local(ToyPlan):
        pass

    with pytest.raises(InputError, match=r"cannot be sent to workers: .*Local.* top of a module"):
        next(map_chunks_on_dask(Local(), [0], cluster.address))
    monkeypatch.setattr(parallel, "_pickled_plan", lambda plan: b"cnowhere_to_be_found\nPlan\n.")
    with pytest.raises(InputError, match=r"The worker tcp://\S+ cannot load the plan \(ModuleNotFoundError:"):
        next(map_chunks_on_dask(ToyPlan(), [0], cluster.address))


def test_workers_of_other_versions_are_refused(cluster: Cluster, monkeypatch: pytest.MonkeyPatch) -> None:
    real = _dask_worker.worker_package_versions()
    with monkeypatch.context() as patch:
        # The function is sent by its name, so that the workers run their own.
        fake = functools.update_wrapper(lambda: real | {"numpy": "0.1"}, _dask_worker.worker_package_versions)
        patch.setattr(_dask_worker, "worker_package_versions", fake)
        message = rf"The worker tcp://\S+ has numpy {real['numpy']} and not 0\.1\. Start the workers in the same env"
        with patch.context() as before:
            before.delattr(distributed.Client, "register_plugin")  # nothing is sent to them
            with pytest.raises(InputError, match=message):
                next(map_chunks_on_dask(ToyPlan(), [0], cluster.address))
        patch.setattr(parallel, "_refuse_dask_workers", lambda *_: None)  # as of a worker that joins later
        with pytest.raises(InputError, match=message):
            next(map_chunks_on_dask(ToyPlan(), [0], cluster.address, retries=0))
    there = {name: version for name, version in real.items() if name != "scipy"}
    with pytest.raises(InputError, match="The worker w has scipy none and not"):
        _dask_worker.refuse_other_worker_versions("w", there, real)


def test_an_address_where_nothing_answers_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parallel, "CONNECT_TIMEOUT", 0.5)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
        for address in (f"tcp://127.0.0.1:{port}", "tcp://", "ftp://x:1", "127.0.0.1:port"):
            with pytest.raises(InputError, match=r"No Dask scheduler answers at .* Start one by `dask scheduler`"):
                next(map_chunks_on_dask(ToyPlan(), [0], address))
    with pytest.raises(InputError, match="address must be that of a Dask scheduler"):
        next(map_chunks_on_dask(ToyPlan(), [0], ""))
    with pytest.raises(InputError, match="retries must be a whole number of at least 0"):
        next(map_chunks_on_dask(ToyPlan(), [0], "a", retries=-1))
    with pytest.raises(InputError, match="patience must be a positive number in s"):
        next(map_chunks_on_dask(ToyPlan(), [0], "a", patience=0))


def test_without_dask_the_message_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def lacking(name: str, *rest: object) -> object:
        if name == "distributed":
            message = "No module named 'distributed'"
            raise ModuleNotFoundError(message, name=name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", lacking)
    with pytest.raises(InputError, match=r"needs the package 'distributed'\. Install it by pip install"):
        next(map_chunks_on_dask(ToyPlan(), [0], "tcp://127.0.0.1:1"))


def test_workers_may_die_and_join_on_the_way(tmp_path: Path) -> None:
    plan = ToyPlan(n_chunks=16, delay=0.15)
    with Cluster(tmp_path) as own:
        seen: list[int] = []
        for number, table in map_chunks_on_dask(plan, range(16), own.address):
            seen.append(number)
            assert table.to_pandas().equals(plan.frame(number))
            if len(seen) == 3:
                own.workers[0].kill()
            if len(seen) == 6:  # nobody is left who holds the plan
                own.workers[1].kill()
                own.add_worker()
        assert sorted(seen) == list(range(16))


def test_a_cluster_without_workers_is_given_up(tmp_path: Path) -> None:
    message = r"has had no worker for 0\.5 s; 0 of the 3 chunks .* Start workers"
    with Cluster(tmp_path, workers=0) as own, pytest.raises(ClusterError, match=message):
        next(map_chunks_on_dask(ToyPlan(), range(3), own.address, patience=0.5))


def test_workers_without_rockflex_are_refused(tmp_path: Path) -> None:
    (tmp_path / "empty" / "rockflex").mkdir(parents=True)
    (tmp_path / "empty" / "rockflex" / "__init__.py").touch()
    message = r"The worker tcp://\S+ cannot use rockflex: .*No module named .* in an environment that has it"
    with (
        Cluster(tmp_path, workers=1, **another_package.environment(tmp_path / "empty")) as own,
        pytest.raises(InputError, match=message),
    ):
        next(map_chunks_on_dask(ToyPlan(), [0], own.address))


def test_a_chunk_that_kills_workers_is_named(tmp_path: Path) -> None:
    message = r"Chunk 2 was on one worker after another when it died; 0 of the 1 chunks .* too little memory"
    with (
        Cluster(tmp_path, DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES="0") as own,
        pytest.raises(ClusterError, match=message),
    ):
        # Alone: of several chunks that a worker has when it dies, Dask names any.
        list(map_chunks_on_dask(DeadlyPlan(), [2], own.address))


def test_a_task_that_kills_workers_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parallel, "chunks_per_task", lambda left, threads, chunk_time: 3)
    with (
        Cluster(tmp_path, DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES="0") as own,
        pytest.raises(
            ClusterError, match=r"One of the chunks 0 to 2 was on one worker after another when it died; 0 of"
        ),
    ):
        list(map_chunks_on_dask(DeadlyPlan(), range(3), own.address))


def test_a_lost_scheduler_is_told_and_the_study_resumes(tmp_path: Path) -> None:
    plan, study = ToyPlan(n_chunks=10, delay=0.1), tmp_path / "study"
    real = plan.whole()
    with Cluster(tmp_path) as own:
        results = map_chunks_on_dask(plan, range(10), own.address)
        with StudyFolder.open(study, {}, 10, {}) as folder:
            for _ in range(4):
                folder.write(*next(results))
            own.scheduler.kill()
            message = r"scheduler at tcp://\S+ was lost .*; [4-9] of the 10 chunks .* run it again"
            with pytest.raises(ClusterError, match=message):  # noqa: PT012
                for number, table in results:
                    folder.write(number, table)
            kept = folder.missing()
    assert 1 <= len(kept) <= 6
    with StudyFolder.open(study, {}, 10, {}) as folder:
        assert folder.missing() == kept
        for number in kept:
            folder.write(number, plan.chunk(number))
        pd.testing.assert_frame_equal(folder.frame(), real)
