"""The examples in the docstrings of the package. Usage: doc_test.py MODULE..."""

import doctest
import importlib
import sys

OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE

if __name__ == "__main__":
    n_failed = n_tried = 0
    for name in sys.argv[1:]:
        failed, tried = doctest.testmod(importlib.import_module(name), optionflags=OPTIONS)
        n_failed, n_tried = n_failed + failed, n_tried + tried
    print(f"{n_tried} examples, {n_failed} failed")
    sys.exit(n_failed > 0 or n_tried == 0)
