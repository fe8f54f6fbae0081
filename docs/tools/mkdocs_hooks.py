"""Hooks of mkdocs.yml: Markdown pages outside docs/ become pages of the site, and links to source files lead to copies.

Pages link to files as GitHub resolves them, relative to their own place in the project. The site has docs/ as its top,
so links are translated: a page in docs/ keeps its path below docs/, every other page has its path in the project, and
source files that a page links to are copied to source/ as text.
"""

import os
import pathlib
import re
import subprocess

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\])\(([^)\s]+)\)")
OTHER_SITE = re.compile(r"^(?:[a-z][a-z0-9+.-]*:|//|#)", re.IGNORECASE)
LEFT_OUT = ("docs/", "build", "tests/", ".")


def outer_pages():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "*.md"], capture_output=True, text=True)
    names = listed.stdout.split() if listed.returncode == 0 else [str(path.relative_to(ROOT)) for path in ROOT.rglob("*.md")]
    return sorted(name for name in names if not name.startswith(LEFT_OUT) and name != "README.md")


def without_code(markdown):
    def blank(match):
        return re.sub(r"[^\n]", " ", match[0])
    text = re.sub(r"^ *(```|~~~).*?^ *\1", blank, markdown, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]+`", blank, text)


def targets_of(markdown, place):
    """The files of the project that a page at `place` (relative to ROOT) links to."""
    for match in LINK.finditer(without_code(markdown)):
        if not OTHER_SITE.match(match[2]):
            yield os.path.normpath(os.path.join(os.path.dirname(place), match[2].partition("#")[0]))


def copied(name):
    """Where the copy of a source file is in the site."""
    return f"source/{name}" if name.endswith((".svg", ".png")) else f"source/{name}.txt"


class Copy(File):
    """A file of the project as text: its content is written by the hook."""

    def __init__(self, name, config):
        super().__init__(copied(name), str(ROOT), config["site_dir"], config["use_directory_urls"])
        self.abs_src_path = str(ROOT / name)


def on_files(files, config):
    for file in list(files):  # the tools that make the manual
        if file.src_path.startswith("tools/") or file.src_path.endswith(("Doxyfile", ".dox")):
            files.remove(file)

    def add(file):
        files.append(file)
    places = {f"docs/{file.src_path}": file.abs_src_path for file in files if file.src_path.endswith(".md")}
    for name in outer_pages():
        add(File(name, str(ROOT), config["site_dir"], config["use_directory_urls"]))
        places[name] = str(ROOT / name)
    wanted = set()
    for place, path in places.items():
        text = pathlib.Path(path).read_text(encoding="utf-8")
        wanted.update(name for name in targets_of(text, place) if name not in places and (ROOT / name).is_file())
    for name in sorted(wanted - {"README.md"}):
        if not name.startswith("docs/"):
            add(Copy(name, config))
    return files


def site_path(name):
    """The path in the site's sources of a file or folder of the project; None if the site lacks it."""
    path = ROOT / name
    if name == "README.md" or name in (".", ""):
        return "index.md"
    if name.startswith("docs/"):
        return name[5:] if path.is_file() else None
    if path.is_dir():
        return f"{name}/README.md" if (path / "README.md").is_file() else None
    return name if name.endswith(".md") and not name.startswith(LEFT_OUT) else copied(name)


def on_page_markdown(markdown, page, config, files):
    own = page.file.src_path
    outer = not page.file.abs_src_path.startswith(config["docs_dir"])
    place = own if outer else f"docs/{own}"
    shown = without_code(markdown)

    def translated(match):
        if shown[match.start():match.start() + 1] == " " or OTHER_SITE.match(match[2]):
            return match[0]
        name, hash_, anchor = match[2].partition("#")
        target = site_path(os.path.normpath(os.path.join(os.path.dirname(place), name)))
        if target is None or files.get_file_from_path(target) is None:
            return match[1].lstrip("!")[1:-1]
        if target == "index.md" and name.endswith("README.md"):
            hash_ = anchor = ""
        return f"{match[1]}({os.path.relpath(target, os.path.dirname(own) or '.')}{hash_}{anchor})"

    return LINK.sub(translated, markdown)
