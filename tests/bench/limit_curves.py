"""What each limit of a verdict costs: good records refused and bad ones accepted, with the limit moved."""
from report import header, row

READING = {"refusal": """Rules that refuse, with their limit multiplied by a factor. Cells: good {what} that the rule
refuses / bad ones that no other rule refuses and that it lets pass. `>` refuses above the limit, `<` below it. Rules
that found nothing are not listed.""", "warning": """Rules that warn, likewise. Cells: good {what} that the rule warns
of / bad ones that no other rule refuses or warns of and that it lets pass.""", "note": """Rules that note, likewise.
Cells: good {what} that the rule notes / bad ones that no rule refuses or warns of and that it lets pass."""}
FACTORS = (0.5, 0.7, 0.85, 1.0, 1.2, 1.4, 2.0)


def is_refused(measured, limit, above, factor):
    return measured > limit * factor if above else measured < limit * factor


def rules_found(record, severity):
    """What speaks against a record: refusals, or with other severities, warnings as well."""
    counted = ("refusal",) if severity == "refusal" else ("refusal", "warning")
    return {(f["code"], f["limit"]) for f in record["findings"] if f["severity"] in counted}


def measures(records, severity):
    """{(code, limit, found above it): [(record, measured)]} of the rules of a severity."""
    # without rules of methods, which state no limit, and those whose limit is 0
    found_by = {(f["code"], f["limit"]): f["measured"] > f["limit"] for r in records for f in r["findings"]
                if f["severity"] == severity and f["limit"] and f["measured"] is not None}
    found = {}
    for record in records:
        for rule in record["findings"] + record["passed"]:
            key = rule["code"], rule["limit"]
            if key in found_by and rule["severity"] == severity and rule["measured"] is not None:
                found.setdefault((*key, found_by[key]), []).append((record, rule["measured"]))
    return found


def cell(found, severity, key, above, factor, good_kinds):
    """(good ones that the rule refuses, or warns of; bad ones that pass all rules)."""
    def passes(record, measured):
        return not rules_found(record, severity) - {key} and not is_refused(measured, key[1], above, factor)

    good = sum(r["kind"] in good_kinds and is_refused(m, key[1], above, factor) for r, m in found)
    return good, sum(r["kind"] not in good_kinds and passes(r, m) for r, m in found)


def curves(records, good, bad, what="sequences", severities=("refusal", "warning")):
    """Lines of the tables, for records of good and bad kinds; without records that state what was measured, none."""
    records = [r for r in records if r["kind"] in good + bad and r.get("passed")]
    lines = []
    for severity in severities:
        found = sorted(measures(records, severity).items())
        if not found:
            continue
        lines += ["", "### Limits of %ss, %s" % (severity, what), "", READING[severity].format(what=what), "",
                  *header("rule", "limit", *("× %g" % f for f in FACTORS))]
        for (code, limit, above), of in found:
            cells = ["%d / %d" % cell(of, severity, (code, limit), above, factor, good) for factor in FACTORS]
            lines.append(row("`%s`" % code, "%s %.3g" % (">" if above else "<", limit), *cells))
    return lines
