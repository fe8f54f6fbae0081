#!/usr/bin/env python3
"""Turns the published EMoR table (text: f0 = ..., h(1)= ... h(25)= ..., 1024 numbers each) into src/core/emor_table.c.

    make_emor_table.py emor.txt > src/core/emor_table.c

emor.txt: Empirical Model of Response, linear domain, Grossberg & Nayar 2004; (c) 2004 Computer Vision Laboratory,
Columbia University; see NOTICE.
"""
import re
import sys

SAMPLES, MODES = 1024, 25

curves = []
for line in open(sys.argv[1]):
    if re.match(r"\s*(f0|h\(\d+\))\s*=", line):
        curves.append([])
    elif line.strip():
        curves[-1] += [float(word) for word in line.split()]
if len(curves) != 1 + MODES or any(len(c) != SAMPLES for c in curves):
    sys.exit("%s: expected %d curves of %d samples" % (sys.argv[1], 1 + MODES, SAMPLES))

print("""/* Made by profiles/tools/make_emor_table.py from emor.txt; do not edit.
 * Empirical Model of Response (EMoR), (c) 2004 Computer Vision Laboratory, Columbia University; see NOTICE.
 * Row 0 is the mean curve f0, row l is the mode h_l, on the uniform irradiance grid j/1023. */
#include "core/emor_table.h"

const double lp_emor_table[1 + LENSPROF_EMOR_MODES][LENSPROF_RESPONSE_SAMPLES] = {""")
for curve in curves:
    print("    {")
    for j in range(0, SAMPLES, 8):
        print("        " + " ".join("%.6e," % v for v in curve[j:j + 8]))
    print("    },")
print("};")
