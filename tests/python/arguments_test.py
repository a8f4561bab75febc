"""Arguments at random, most of them wrong: each call gives a result or an exception of one line, and none ends the interpreter.

    arguments_test.py [N [SEED]]: N calls (600) from this seed (1)
"""
import sys

import numpy as np
import tessera
from oracles import kuhn

n_calls, seed = (int(word) for word in (sys.argv[1:] + ["600", "1"][len(sys.argv) - 1:]))
rng = np.random.default_rng(seed)
POINTS, TETS = kuhn(2, 0.2)
MANGLE = [lambda a: a * 0, lambda a: a * [1, 1, 0], lambda a: a * 1e90, lambda a: a * 1e300, lambda a: a * 1e-100, lambda a: a[:, :2],
          lambda a: np.where(rng.random(a.shape) < 0.1, np.nan, a), lambda a: np.repeat(a, 3, 0), lambda a: a.astype(np.float32),
          lambda a: np.rint(3 * a).astype(int), lambda a: None, lambda a: a.tolist()]


def any_of(*things):
    return things[rng.integers(len(things))]


def mostly(*things):
    """The first one, in nine of ten cases."""
    return things[0] if rng.random() < 0.9 else any_of(*things)


def points():
    return mostly(lambda a: a, *MANGLE)(any_of(POINTS, rng.random((rng.integers(0, 40), 3)) * 10.0 ** rng.integers(-3, 3)))


def numbers(n, *shape):
    return rng.integers(-1 if rng.random() < 0.1 else 0, max(n, 1), shape)


def cells(of):
    n = len(of) if of is not None else 5
    some = numbers(n, rng.integers(0, 30), any_of(4, 4, 4, 3, 2, 5, 1))
    return any_of(None, TETS, some, some, some.astype(np.uint8), some * 0, some * 10**10, some * 1.0)


def values(of):
    n = len(of) if of is not None else 5
    return mostly(rng.random(n), rng.random((n, rng.integers(0, 4))), np.full(n, np.nan), np.full(n, 1e308), rng.random(n + 1))


def objects():
    some = rng.random((rng.integers(0, 50), *any_of((6,), (3, 3), (4, 3), (4,), (2, 3), (3,), (5,))))
    if some.shape[1:] == (6,):
        some = np.sort(some.reshape(-1, 2, 3), 1).reshape(-1, 6)
    return any_of(some, some, some, -some, some * 0, some * 10.0 ** rng.integers(-200, 200), some / 0 if rng.random() < 0.3 else some)


def transfer():
    source, target = mostly(POINTS, points()), points()
    tets = mostly(TETS if source is POINTS else None, cells(source))
    target_tets = cells(target)
    if rng.random() < 0.4:
        target, target_tets = kuhn(rng.integers(1, 4))
    options = {"kind": any_of(*tessera.KINDS, "native", "?"), "outside": mostly(None, "nearest", "keep", 3.0, np.nan, "value:1"),
               "tolerance": mostly(0.0, 0.1, -1.0, np.nan, 1e101), "order": mostly(1, 2, 0), "clamp": mostly(False, True),
               "pes": mostly(2, 1, 3, 0), "target_tets": target_tets}
    if rng.random() < 0.6:
        return any_of(lambda r: r, lambda r: r.donors)(tessera.transfer(source, tets, values(source), target, **options))
    coupling = tessera.Coupling(source, tets, target, **options)
    return coupling.apply(values(source)), any_of(coupling.weights_csr, lambda: None)()


def pairs():
    return tessera.collide.pairs(objects(), any_of(None, objects()), touching=any_of(True, False))


def queries():
    index, of = tessera.collide.Index(objects()), points()
    return any_of(lambda: index.nearest(of, int(rng.integers(-1, 50))), lambda: index.within(of, any_of(0.0, 1.0, 1e200, -1.0, np.nan)),
                  lambda: index.ray(of, any_of(of, points())))()


def distances():
    of = points()
    field = tessera.sdf.build(of, mostly(numbers(10, 10, 3), cells(of)), mostly(8, 4, 16, 3, -1),
                              margin=mostly(None, 0.1, 1.0, -1.0, np.nan, 1e200), thickness=mostly(np.inf, 1.0, 0.0, np.nan),
                              two_sided=any_of(True, False))
    return field.sample(points(), any_of(*tessera.sdf.KINDS))


def balance():
    n, pes = int(rng.integers(0, 30)), int(rng.integers(0, 6))
    scale = lambda: 10.0 ** rng.integers(-300, 300)
    snapshot = tessera.balance.snapshot(np.where(rng.random(n) < 0.1, np.nan, rng.random(n) * any_of(1, 1, scale())), numbers(pes, n), pes,
                                        speeds=any_of(None, rng.random(pes), rng.random(pes) * scale()), background=any_of(None, rng.random(pes)),
                                        sizes=any_of(None, numbers(2**53, n)), edges=any_of(None, numbers(n, 20, 4)),
                                        positions=any_of(None, rng.random((n, 3))))
    own = any_of(*tessera.balance.strategies(), lambda s: numbers(pes, n), lambda s: s.loads, lambda s: None)
    return tessera.balance.evaluate(snapshot, tessera.balance.assign(snapshot, own, int(rng.integers(0, 9))))


done = {}
np.seterr(all="ignore")
for k in range(n_calls):
    call = any_of(transfer, transfer, transfer, pairs, queries, distances, balance)
    try:
        call()
        done[call.__name__] = done.get(call.__name__, 0) + 1
    except tessera.Error as error:
        if "\n" in str(error) or len(str(error)) < 20:
            sys.exit(f"call {k}, {call.__name__}: no sentence: {error}")
    except TypeError as error:
        if "incompatible function arguments" in str(error):
            sys.exit(f"call {k}, {call.__name__}: an argument was not checked: {error}")
print(f"{n_calls} calls; with a result: {done}")
if len(done) < 5:
    sys.exit("some calls never give a result: too much is wrong")
