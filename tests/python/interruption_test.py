"""Ctrl-C stops work within a second."""

import signal
import subprocess
import sys
import time

PROGRAM = """
import bandvox, sys
print("starting", flush=True)
try:
    bandvox.bandlimit("shape:tree", resolution=3000)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    sys.exit(7)
"""


def test_an_interruption_ends_the_work():
    process = subprocess.Popen([sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "starting\n"
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert out == "interrupted\n"
    assert process.returncode == 7
