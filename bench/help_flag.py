# SPDX-License-Identifier: Apache-2.0
"""--help for the scripts of this folder."""
import sys


def answer_help(text):
    """Print `text`, a script's docstring, and exit, if its first argument is -h or --help."""
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(text.strip())
        sys.exit(0)
