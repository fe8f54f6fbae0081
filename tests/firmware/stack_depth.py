#!/usr/bin/env python3
"""The deepest stack of a function, from the compiler's call graph (gcc -fcallgraph-info=su).

usage: stack_depth.py LIMIT FUNCTION INDIRECT FILE.ci...   INDIRECT: called through a pointer ("-": nothing);
                                                           CALLER=CALLED,... if several functions do so
       stack_depth.py --self-check

Functions of the C and compiler libraries are not in the graph and count as OUTSIDE bytes. Exit 1 beyond the limit, for
recursion, and if a frame's size is unknown.
"""

import re
import sys

OUTSIDE = 64
NODE = re.compile(r'node: \{ title: "([^"]+)" label: "([^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')


class Graph:
    def __init__(self, texts, indirect):
        self.frame, self.calls = {}, {}
        self.indirect = dict(pair.split("=") if "=" in pair else ("", pair) for pair in indirect.split(","))
        for text in texts:
            for name, label in NODE.findall(text):
                size = re.search(r"(\d+) bytes \(([^)]*)\)", label)
                if size:
                    if size.group(2) not in {"static", "dynamic,bounded"}:
                        sys.exit(f"{name}: the frame's size is {size.group(2)}")
                    self.frame[name] = int(size.group(1))
            for source, target in EDGE.findall(text):
                self.calls.setdefault(source, set()).add(target)

    def deepest(self, name, above=()):
        """Stack bytes, and the call path."""
        if name == "__indirect_call":
            name = self.indirect.get(above[-1], self.indirect.get("", "-"))
            if name not in self.frame:
                sys.exit(f"{above[-1]} calls by pointer: {name} is not in the graph")
        if name in above:
            sys.exit(f"{name} calls itself")
        if name not in self.frame:
            return OUTSIDE, [f"{name} ({OUTSIDE} reserved)"]
        below = [self.deepest(callee, (*above, name)) for callee in sorted(self.calls.get(name, ()))]
        depth, path = max(below, default=(0, []))
        return depth + self.frame[name], [f"{name.split(':')[-1]} {self.frame[name]}", *path]


def self_check():
    text = 'node: { title: "a" label: "a\\nx.c:1:1\\n16 bytes (static)" }\nnode: { title: "x.c:b" label: "b\\n8 bytes (static)" }\n'
    text += 'node: { title: "memcpy" label: "memcpy\\n<built-in>" shape : ellipse }\n'
    text += 'edge: { sourcename: "a" targetname: "__indirect_call" }\nedge: { sourcename: "a" targetname: "memcpy" }\n'
    text += 'edge: { sourcename: "x.c:b" targetname: "memcpy" }\n'
    wanted = (24 + OUTSIDE, ["a 16", "b 8", f"memcpy ({OUTSIDE} reserved)"])
    good = all(Graph([text], pointed).deepest("a") == wanted for pointed in ("x.c:b", "b=c,a=x.c:b"))
    print("stack_depth: found" if good else "stack_depth: not found")
    return 0 if good else 1


def main():
    if sys.argv[1:] == ["--self-check"]:
        return self_check()
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    texts = []
    for name in sys.argv[4:]:
        with open(name, encoding="utf-8") as file:
            texts.append(file.read())
    graph = Graph(texts, sys.argv[3])
    if sys.argv[2] not in graph.frame:
        sys.exit(f"{sys.argv[2]} is not in the graph")
    depth, path = graph.deepest(sys.argv[2])
    print(f"{depth} of {sys.argv[1]} bytes: {', '.join(path)}")
    return int(depth > int(sys.argv[1]))


if __name__ == "__main__":
    sys.exit(main())
