"""What each limit of the verdict costs: good sequences refused and bad ones accepted, with the limit moved."""
from report import header, row
from verdicts import BAD, GOOD

READING = """Rules that refuse, with their limit multiplied by a factor. Cells: good sequences that the rule refuses / bad
ones that no other rule refuses and that it lets pass. `>` refuses above the limit, `<` below it. Rules that found
nothing at any factor are not listed."""
FACTORS = (0.5, 0.7, 0.85, 1.0, 1.2, 1.4, 2.0)


def is_refused(measured, limit, above, factor):
    return measured > limit * factor if above else measured < limit * factor


def refusals(record):
    return {f["code"] for f in record["findings"] if f["severity"] == "refusal"}


def measures(records):
    """{(code, limit, refuses above it): [(record, measured)]} of rules that refuse."""
    refusing = {(f["code"], f["limit"]): f["measured"] > f["limit"] for r in records for f in r["findings"]
                if f["severity"] == "refusal" and f["limit"] is not None and f["measured"] is not None}
    found = {}
    for record in records:
        for rule in record["findings"] + record["passed"]:
            key = rule["code"], rule["limit"]
            if key in refusing and rule["severity"] == "refusal" and rule["measured"] is not None:
                found.setdefault((*key, refusing[key]), []).append((record, rule["measured"]))
    return found


def cell(found, code, limit, above, factor):
    """(good ones that the rule refuses, bad ones that pass all rules)."""
    good = sum(r["kind"] in GOOD and is_refused(m, limit, above, factor) for r, m in found)
    bad = sum(r["kind"] in BAD and not refusals(r) - {code} and not is_refused(m, limit, above, factor)
              for r, m in found)
    return good, bad


def curves(records):
    """Lines of the table; without records that state what was measured, none."""
    records = [r for r in records if r["kind"] in GOOD + BAD and r.get("passed")]
    found = sorted(measures(records).items())
    if not found:
        return []
    lines = ["", "### Limits", "", READING, "", *header("rule", "limit", *("× %g" % f for f in FACTORS))]
    for (code, limit, above), of in found:
        cells = ["%d / %d" % cell(of, code, limit, above, factor) for factor in FACTORS]
        lines.append(row("`%s`" % code, "%s %.3g" % (">" if above else "<", limit), *cells))
    return lines
