"""The queue of units, in simulated time."""

import heapq
from dataclasses import dataclass

import pytest

pytest.importorskip("ray")

from lightmesh.ray._queue import COPIES, DEPTH, Queue, Worker
from lightmesh.ray._units import LEAST_ROWS, MOST_BYTES, PIXEL_BYTES, bands


@dataclass(frozen=True)
class Piece:
    name: str
    weight: float = 1.0

    def run(self, worker, place):
        raise NotImplementedError


def pieces(count):
    return [Piece(f"piece {number}") for number in range(count)]


def simulate(queue, paces):
    """Lets workers do all units, each at its pace in seconds for a unit; returns when the last one is finished."""
    workers = [Worker(f"w{number}", f"n{number}") for number in range(len(paces))]
    pace = dict(zip(workers, paces))
    ends = []

    def hand_out(now):
        for worker in sorted(workers, key=lambda worker: len(worker.held)):
            begins = not worker.held
            while (unit := queue.take(worker, workers, now)) is not None:
                if begins:
                    heapq.heappush(ends, (now + pace[worker] * unit.weight, workers.index(worker)))
                    begins = False

    hand_out(0.0)
    while not queue.is_finished:
        now, number = heapq.heappop(ends)
        worker = workers[number]
        queue.done(queue.units[next(iter(worker.held))], worker, now)
        if worker.held:
            unit = queue.units[next(iter(worker.held))]
            heapq.heappush(ends, (now + pace[worker] * unit.weight, number))
        hand_out(now)
        assert all(len(worker.held) <= DEPTH for worker in workers)
        assert all(len(queue.copies_of(unit)) <= COPIES for unit in queue.units.values())
    return now


@pytest.mark.parametrize("count", [1, 2, 4, 8])
def test_equal_workers_finish_together(count):
    assert simulate(Queue(pieces(40)), [1.0] * count) == pytest.approx(40 / count)


def test_one_worker_ten_times_slower_costs_little():
    paces = [1.0, 1.0, 1.0, 10.0]
    ideal = 60 / sum(1 / pace for pace in paces)
    assert simulate(Queue(pieces(60)), paces) <= 1.15 * ideal


def test_without_copies_it_would_cost_more(monkeypatch):
    """The test above can fail."""
    monkeypatch.setattr("lightmesh.ray._queue.COPIES", 1)
    paces = [1.0, 1.0, 1.0, 40.0]
    assert simulate(Queue(pieces(60)), paces) > 1.15 * 60 / sum(1 / pace for pace in paces)


def test_the_last_units_are_not_handed_out_in_advance():
    queue, workers = Queue(pieces(4)), [Worker("a", "n"), Worker("b", "m")]
    a, b = workers
    assert queue.take(a, workers, 0.0).name == "piece 0"
    assert queue.take(a, workers, 0.0).name == "piece 1"
    assert queue.take(a, workers, 0.0) is None, "it holds two"
    assert queue.take(b, workers, 0.0).name == "piece 2"
    assert queue.take(b, workers, 0.0) is None, "one is left for whoever comes first"
    assert queue.done(queue.units["piece 2"], b, 1.0)
    assert queue.take(b, workers, 1.0).name == "piece 3"


def test_the_first_result_wins():
    queue, workers = Queue(pieces(1)), [Worker("a", "n"), Worker("b", "m"), Worker("c", "o")]
    a, b, c = workers
    unit = queue.take(a, workers, 0.0)
    assert queue.take(b, workers, 1.0) is unit and queue.copies == 1
    assert queue.take(c, workers, 1.0) is None, "two copies are enough"
    assert queue.done(unit, b, 2.0) and queue.is_finished
    assert queue.copies_of(unit) == [a]
    assert not queue.done(unit, a, 3.0) and queue.is_finished


def test_what_a_lost_worker_held_comes_first():
    queue, workers = Queue(pieces(9)), [Worker("a", "n"), Worker("b", "m")]
    a, b = workers
    held = [queue.take(a, workers, 0.0), queue.take(a, workers, 0.0)]
    assert queue.lost(a) == held and queue.losses == {"piece 0": 1}
    assert [queue.take(b, workers, 1.0), queue.take(b, workers, 1.0)] == held and queue.retries == 2


def test_a_copy_that_is_lost_is_no_retry():
    queue, workers = Queue(pieces(1)), [Worker("a", "n"), Worker("b", "m")]
    a, b = workers
    unit = queue.take(a, workers, 0.0)
    queue.take(b, workers, 0.0)
    queue.lost(a)
    assert queue.retries == 0 and queue.done(unit, b, 1.0)


def test_what_a_node_has_no_memory_for_goes_elsewhere():
    queue, workers = Queue(pieces(2)), [Worker("a", "small"), Worker("b", "small"), Worker("c", "large")]
    a, b, c = workers
    unit = queue.take(a, workers, 0.0)
    queue.refuse(unit, a, 1.0)
    assert queue.can_go_to(unit, ["small", "large"]) and not queue.can_go_to(unit, ["small"])
    assert queue.take(b, workers, 1.0).name == "piece 1", "another worker of the node does not get it"
    assert queue.take(c, workers, 1.0) is unit


@pytest.mark.parametrize(
    ("width", "height", "actors"),
    [(160, 2560, 4), (64, 30, 4), (1024, 64, 1), (1024, 127, 9), (32768, 32768, 2), (100_000, 70, 3), (7, 1, 1)],
)
def test_bands_have_all_rows(width, height, actors):
    heights = bands(width, height, actors)
    assert sum(heights) == height and max(heights) - min(heights) <= 1
    assert min(heights) >= min(LEAST_ROWS, height)
    assert max(heights) * width * PIXEL_BYTES <= max(MOST_BYTES, 2 * LEAST_ROWS * width * PIXEL_BYTES)
