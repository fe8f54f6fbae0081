"""The tables of the part `cards`."""
import limit_curves
from cards import BAD, GOOD, HARM, NAMED
from report import count, header, median, number, row
from verdict_tables import held

READING_CARDS = """Rendered cards, every option drawn from the seed. Good ones should be accepted, bad ones refused
unless their falloff is right. Corner: the light there; over the frame: the largest relative error anywhere of what is
applied, polynomial and gain grid, of the accepted ones. Harm: accepted, and that error is above {harm:g} %; named: by a
warning, or by the note that names what is wrong where one card cannot show more ({named}). The
curves count only bad cards with an error above {harm:g} %. Targets are in brackets. To repeat a case:
`run.sh --only cards --match "even 17"{tune}`."""


def is_harmful(record):
    return record["usable"] and record["frame_error"] > HARM


def is_named(record):
    codes = {f["code"] for f in record["findings"]}
    return bool(record["reason"]) or bool(codes.intersection(NAMED.get(record["kind"], ())))


def is_missed(record):
    """What is wrong with the verdict, in a few words, or None."""
    if record["kind"] in GOOD and not record["usable"]:
        return "refused"
    return "harm that nothing names" if is_harmful(record) and not is_named(record) else None


def cards(results):
    """Both errors of the verdict on cards, the curves of its limits, and the cards concerned."""
    if not results or not (results["records"] or results["skipped"]):
        return []
    records = results["records"]
    lines = ["## Cards", "", READING_CARDS.format(harm=100 * HARM, named=", ".join(
        "%s: `%s`" % (kind, "` or `".join(codes)) for kind, codes in NAMED.items()), tune=" --tune" if results["tune"] else ""), ""]
    if results["skipped"]:
        lines += ["SKIPPED: %d JPEG cards: no OpenCV" % len(results["skipped"]), ""]
    lines += header("kind", "cards", "refused", "accepted", "with a warning", "corner: from", "to", "error: median",
                    "worst", "over the frame: median", "worst", "harm, named", "harm, not named",
                    "corner within its standard error", "seconds")
    by_kind = {kind: [r for r in records if r["kind"] == kind] for kind in GOOD + BAD}
    totals = {"all good": sum((by_kind[k] for k in GOOD), []), "all bad": sum((by_kind[k] for k in BAD), [])}
    lines += [card_row(kind, of) for kind, of in {**by_kind, **totals}.items() if of]
    counted = [r for r in records if r["kind"] in GOOD or r["frame_error"] > HARM]
    lines += limit_curves.curves(counted, GOOD, BAD, "cards", ("refusal", "warning", "note"))
    missed = [r for r in records if is_missed(r)]
    if missed:
        lines += ["", "Missed.", "", *header("case", "what", "corner", "found", "over the frame", "findings")]
        lines += [row(r["name"], is_missed(r), number(r["true_corner"]), number(r["corner"]), number(r["frame_error"]),
                      ", ".join("`%s`" % f["code"] for f in r["findings"]) or "nothing") for r in missed]
    return lines + [""]


def card_row(kind, of):
    accepted = [r for r in of if r["usable"]]
    off = [{"corner": abs(r["corner"] - r["true_corner"]), "frame": r["frame_error"]} for r in accepted]
    figures = [figure for key in ("corner", "frame")
               for figure in (number(median(off, key)), number(max((r[key] for r in off), default=None)))]
    harmful, corners = [r for r in accepted if is_harmful(r)], [r["true_corner"] for r in of]
    named = count(harmful, is_named)
    return row(kind, len(of), len(of) - len(accepted), len(accepted), count(accepted, lambda r: r["reason"]),
               "%.2f" % min(corners), "%.2f" % max(corners), *figures, named, len(harmful) - named,
               held([r["z"] for r in accepted if r["z"] is not None]) if of[0]["kind"] in GOOD else "",
               "%.2f" % median(of, "seconds"))
