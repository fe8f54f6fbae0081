"""Pages of the manual that a script makes: written, or compared with what is committed."""


def write_or_check(root, name, text, checks):
    """Writes the text to the file `name` below `root`; with `checks` compares it. Returns the exit code."""
    target = root / name
    if not checks:
        target.write_text(text, encoding="utf-8")
        return 0
    if target.is_file() and target.read_text(encoding="utf-8") == text:
        print(f"{name} is up to date")
        return 0
    print(f"{name} is out of date: run `make docs-update` and commit it")
    return 1
