#!/usr/bin/env python3
"""Links and anchors of the Markdown files: every relative link leads to a file or folder of the project, every anchor to
a heading. No network: links to other sites are not looked at.

usage: check_links.py SOURCE_DIR      list dead links; exit 1 if there are any
       check_links.py --self-check    plant dead links in a made-up tree; exit 1 if one is not found
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import urllib.parse

LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\)|^\[[^\]^]+\]:\s*(\S+)|(?:href|src)=\"([^\"]+)\"",
                  re.MULTILINE)
OTHER_SITE = re.compile(r"^(?:[a-z][a-z0-9+.-]*:|//)", re.IGNORECASE)
# Pages that `make docs` makes, as links in docs/ name them.
MADE = ("docs/api/",)


def blank(match):
    return re.sub(r"[^\n]", " ", match[0])


def without_code(markdown):
    text = re.sub(r"^ *(```|~~~).*?^ *\1", blank, markdown, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"<!--.*?-->", blank, text, flags=re.DOTALL)
    return re.sub(r"`[^`\n]+`", blank, text)


def anchors_of(markdown):
    """The anchors of the headings, as GitHub makes them."""
    text = re.sub(r"^ *(```|~~~).*?^ *\1", blank, markdown, flags=re.MULTILINE | re.DOTALL)
    found = set(re.findall(r"(?:id|name)=\"([^\"]+)\"", text))
    for heading in re.findall(r"^#{1,6} +(.*?)[ #]*$", text, re.MULTILINE):
        plain = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower().replace("`", "")
        slug = re.sub(r"[^\w\- ]", "", plain).strip().replace(" ", "-")
        number = 0
        while (f"{slug}-{number}" if number else slug) in found:
            number += 1
        found.add(f"{slug}-{number}" if number else slug)
    return found


def pages_of(root):
    listed = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard", "*.md"], capture_output=True, text=True)
    if listed.returncode == 0:
        return [root / name for name in sorted(set(listed.stdout.split())) if (root / name).is_file()]
    return [path for path in sorted(root.rglob("*.md")) if not path.relative_to(root).parts[0].startswith(("build", "."))]


def check(root):
    anchors = {}
    for page in pages_of(root):
        markdown = page.read_text(encoding="utf-8")
        text = without_code(markdown)
        for match in LINK.finditer(text):
            link = next(group for group in match.groups() if group)
            if OTHER_SITE.match(link):
                continue
            place = f"{page.relative_to(root)}:{text.count(chr(10), 0, match.start()) + 1}"
            name, _, anchor = urllib.parse.unquote(link).partition("#")
            target = (page.parent / name).resolve() if name else page
            if root not in target.parents and target != root:
                yield f"{place}: {link} leads out of the project"
            elif str(target.relative_to(root)).startswith(MADE) or f"{target.relative_to(root)}/" in MADE:
                continue
            elif not target.exists():
                yield f"{place}: {link}: there is no {target.relative_to(root)}"
            elif anchor and target.suffix == ".md":
                if target not in anchors:
                    anchors[target] = anchors_of(target.read_text(encoding="utf-8"))
                if anchor not in anchors[target]:
                    yield f"{place}: {link}: {target.relative_to(root)} has no heading #{anchor}"


def self_check():
    good = "# One two\n## `a` and, b\n[x](b.md) [y](b.md#a-head-1) [z](#a-and-b) ![p](d/) `[n](none)` <!-- [n](none) -->\n"
    good += "```\n[n](none)\n```\n[site](https://x.org/none) [made](docs/api/index.html)\n"
    bad = ("[x](none.md)", "[x](b.md#none)", "[x](#none)", "![x](d/none.svg)", "[x](../../out.md)", "[r]: none.md", '<a href="none.md">')
    wrong = []
    with tempfile.TemporaryDirectory() as place:
        root = pathlib.Path(place).resolve()
        (root / "d").mkdir()
        (root / "b.md").write_text("# A head\n# A head\n")
        (root / "a.md").write_text(good)
        wrong += list(check(root))
        for text in bad:
            (root / "a.md").write_text(f"# A\n\n{text}\n")
            if len(list(check(root))) != 1:
                wrong.append(f"{text}: not found")
    print("\n".join(wrong) or f"check_links: {len(bad)} planted links found")
    return 1 if wrong else 0


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if sys.argv[1] == "--self-check":
        return self_check()
    dead = list(check(pathlib.Path(sys.argv[1]).resolve()))
    print("\n".join(dead) or "check_links: every link leads somewhere")
    return 1 if dead else 0


if __name__ == "__main__":
    sys.exit(main())
