"""Rows as `lightmesh report` reads them."""

DIGITS = 12
"""Digits of numbers: as many as every reader of JSON gets right."""


def row(experiment, keys, seconds, values):
    words = " ".join(f"{name}={key}" for name, key in sorted(keys.items()))
    seconds = {name: [rounded(sample) for sample in samples] for name, samples in seconds.items()}
    values = {name: rounded(value) for name, value in values.items()}
    return {"id": f"{experiment}: {words}", "experiment": experiment, "keys": keys, "seconds": seconds, "values": values}


def rounded(number):
    return float(f"{number:.{DIGITS}g}")
