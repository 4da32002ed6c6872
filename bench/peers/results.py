"""Rows as `lightmesh report` reads them."""


def row(experiment, keys, seconds, values):
    words = " ".join(f"{name}={key}" for name, key in sorted(keys.items()))
    values = {name: float(value) for name, value in values.items()}
    return {"id": f"{experiment}: {words}", "experiment": experiment, "keys": keys, "seconds": seconds, "values": values}
