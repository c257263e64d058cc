#!/usr/bin/env python3
"""Grasps in bulk as a Parquet table: a row a grasp, for pandas, polars, DuckDB and their like.

    regrasp grasps allegro-cube -n 10000 -o grasps.npz
    python3 examples/16_grasps_as_parquet.py grasps.npz grasps.parquet

Needs numpy and pyarrow. Arrays of a grasp become lists: `joints` of numbers, `contact_point_O` of a list for each finger. What does
not exist is NaN, or -1 among whole numbers, as in the archive. The problem and what the set is go into the table's metadata, so that
the file stands alone; regrasps between grasps (`--graph`) go there too.
"""

import json
import sys

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq


def column(array):
    """An array as a column, its inner dimensions as lists of fixed length."""
    flat = pa.array(np.ascontiguousarray(array).reshape(-1))
    for size in reversed(array.shape[1:]):
        flat = pa.FixedSizeListArray.from_arrays(flat, int(size))
    return flat


def table(arrays):
    """The table of an archive that `regrasp grasps` wrote."""
    count = len(arrays["pose"])
    rows = {name: column(arrays[name]) for name in arrays.files if arrays[name].ndim and len(arrays[name]) == count}
    for name in ("finger_names", "joint_names", "edges", "edge_finger"):
        rows.pop(name, None)
    told = {name: str(arrays[name]) for name in ("grasps_info", "grasps_problem")}
    told |= {name: json.dumps(arrays[name].tolist()) for name in ("finger_names", "joint_names", "edges", "edge_finger") if name in arrays}
    return pa.table(rows).replace_schema_metadata(told)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.split("\n\n")[1])
    source, target = sys.argv[1:]
    with np.load(source, allow_pickle=False) as arrays:
        if "grasps_info" not in arrays:
            sys.exit(f"{source}: it holds no grasps of `regrasp grasps`")
        made = table(arrays)
    pq.write_table(made, target)
    print(f"{target}: {made.num_rows} grasps, {made.num_columns} columns")


if __name__ == "__main__":
    main()
