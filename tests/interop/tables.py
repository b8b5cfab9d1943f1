"""Tables of rows that are right or wrong, as the tests against the other kernel print them."""
import concurrent.futures
import os
import sys


def judged(jobs, rows_of, shown, label_of, known, workers=2):
    """Prints the rows of all jobs in their order; the labels of those that are wrong, and how many rows there are.

    `rows_of` gives a list of (cells, right) for a job, of which `cells["why"]` tells what is wrong. A row that is known to be wrong must
    be: one that has come right has to be taken out of `known`.
    """
    wrong, n = [], 0
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        for rows in pool.map(rows_of, jobs):
            for cells, right in rows:
                n += 1
                label = label_of(cells)
                cause = known.get(label)
                cells["why"] += f" (known: {cause})" if cause else ""
                print(shown(cells), flush=True)
                if cause and right:
                    print(f"{label} is right: take it out of the known ones", flush=True)
                if right == bool(cause):
                    wrong.append(label)
    return wrong, n


def main(table):
    """Runs one table by itself: LOFT WORK [NAME ...]."""
    loft, work = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    wrong, n = table(loft, work, sys.argv[3:])
    print(f"{n - len(wrong)} of {n} right")
    return 1 if wrong else 0
