#!/usr/bin/env python3
"""Writes docs/reference/schema.md from profiles/schema/*.sql.

usage: schema.py SOURCE_DIR            write the page
       schema.py SOURCE_DIR --check    exit 1 if the page is out of date; exit 77 if SQLite is too old (3.37)

The SQL is run in memory, layout by layout: tables and columns are those of the database that results. What a column
means is the comment next to it, and what a table means is the comment before it.
"""

import pathlib
import re
import sqlite3
import sys

from generated import write_or_check

HEAD = """# Database schema

<!-- Made by docs/tools/schema.py from profiles/schema/*.sql; `make docs-update` makes it again. -->

The profile database is one SQLite file of layout {layout}. [The profile database](../database.md) explains what is in it;
this page lists tables and columns. Write with lensprof, not with other programs, unless you keep to the constraints of
[the SQL](../../profiles/schema).

```text
{conventions}
```

"""


def columns_of(database):
    tables = [row[0] for row in database.execute("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY rowid")]
    return {table: list(database.execute(f"PRAGMA table_info({table})")) for table in tables if not table.startswith("sqlite_")}


def comments_of(sql):
    """What is written before each table, next to or before each column, as {(table, column): text}; column '' = table."""
    found, table, pending = {}, "", []
    for line in sql.splitlines():
        code, _, comment = line.partition("--")
        code, comment = code.strip(), comment.strip()
        if not code:
            pending = pending + [comment] if comment else []
            continue
        created = re.match(r"CREATE TABLE (\w+)", code)
        altered = re.match(r"ALTER TABLE (\w+) ADD COLUMN (\w+)", code)
        column = re.match(r"(\w+) +(?:INTEGER|REAL|TEXT|BLOB)\b", code)
        if created:
            table = created[1]
            found[table, ""] = " ".join(pending)
            pending = []
        elif altered:
            found[altered[1], altered[2]] = comment or " ".join(pending)
        elif column and table:
            found[table, column[1]] = comment
            pending = []
        elif code.startswith(")"):
            table, pending = "", []
    return found


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;") or " "


def page(root):
    database, since, comments = sqlite3.connect(":memory:"), {}, {}
    for layout, path in enumerate(sorted((root / "profiles/schema").glob("*.sql")), 1):
        sql = path.read_text(encoding="utf-8")
        database.executescript(sql)
        for key, text in comments_of(sql).items():
            comments.setdefault(key, text)
        for table, columns in columns_of(database).items():
            for column in ["", *(row[1] for row in columns)]:
                since.setdefault((table, column), layout)
    first = sorted((root / "profiles/schema").glob("*.sql"))[0].read_text(encoding="utf-8")
    conventions = "\n".join(line[2:].removeprefix(" ") for line in first.split("\n\n")[0].splitlines()[2:])
    text = HEAD.format(layout=layout, conventions=conventions)
    for table, columns in columns_of(database).items():
        text += f"## `{table}`\n\nSince layout {since[table, '']}. {cell(comments.get((table, ''), ''))}".rstrip() + "\n\n"
        text += "| column | type | may be NULL | key | since layout | notes |\n|---|---|---|---|---|---|\n"
        for _, name, kind, not_null, _, key in columns:
            text += (f"| `{name}` | {kind} | {'' if not_null or key else 'yes'} | {key or ''} | {since[table, name]} | "
                     f"{cell(comments.get((table, name), ''))} |\n")
        text += "\n"
    indexes = database.execute("SELECT name, tbl_name FROM sqlite_master WHERE type = 'index' AND sql NOT NULL ORDER BY rowid")
    text += "## Indexes\n\n" + "".join(f"- `{name}` on `{table}`\n" for name, table in indexes)
    return text


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--check"]):
        sys.exit(__doc__)
    if sqlite3.sqlite_version_info < (3, 37):
        print("skipped: SQLite is older than 3.37")
        return 77
    root = pathlib.Path(sys.argv[1])
    return write_or_check(root, "docs/reference/schema.md", page(root), "--check" in sys.argv)


if __name__ == "__main__":
    sys.exit(main())
