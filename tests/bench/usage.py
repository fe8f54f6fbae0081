#!/usr/bin/env python3
"""usage.py FILE SECONDS UNTIL COMMAND...: runs a command, kills it after SECONDS or, unless UNTIL is empty, when its
standard error, which is a file, has that text; writes its resource usage to FILE.

A separate process, because a child's peak memory counts from the fork: it must not inherit NumPy's.
"""
import json
import os
import signal
import sys
import time

report, limit, until, command = sys.argv[1], int(sys.argv[2]), sys.argv[3].encode(), sys.argv[4:]
start = time.perf_counter()
child = os.posix_spawnp(command[0], command, os.environ)
signal.signal(signal.SIGALRM, lambda *_: os.kill(child, signal.SIGKILL))
signal.alarm(limit)
ended, status, used = os.wait4(child, os.WNOHANG if until else 0)
while not ended and until not in os.pread(2, os.fstat(2).st_size, 0):
    time.sleep(0.1)
    ended, status, used = os.wait4(child, os.WNOHANG)
if not ended:
    os.kill(child, signal.SIGKILL)
    _, status, used = os.wait4(child, 0)
wall = time.perf_counter() - start
signal.alarm(0)
with open(report, "w") as file:
    json.dump({"code": os.waitstatus_to_exitcode(status), "wall_s": wall, "cpu_s": used.ru_utime + used.ru_stime,
               "peak_mb": used.ru_maxrss / 1024.0}, file)
