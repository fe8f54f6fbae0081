"""The tables of the part `cards`."""
import limit_curves
from cards import BAD, GOOD, HARM
from report import count, header, median, number, row
from verdict_tables import held

READING_CARDS = """Rendered cards, every option drawn from the seed. Good ones should be accepted, bad ones refused
unless their falloff is right. Error of M: largest relative error over the half diagonal, of the accepted ones. Over the
frame: likewise at every place, with the centre and the gain grid. Harm: accepted, and the error of M is above
{harm:g} %. Right: accepted with a smaller error, which does no harm. A note is not a warning. The curves count only bad
cards with an error above {harm:g} %. Targets are in brackets. To repeat a case:
`run.sh --only cards --match "even 17"{tune}`."""


def is_harmful(record):
    return record["usable"] and record["error"] > HARM


def is_missed(record):
    """What is wrong with the verdict, in a few words, or None."""
    if record["kind"] in GOOD and not record["usable"]:
        return "refused"
    return "accepted without a warning" if is_harmful(record) and not record["reason"] else None


def cards(results):
    """Both errors of the verdict on cards, the curves of its limits, and the cards concerned."""
    if not results or not (results["records"] or results["skipped"]):
        return []
    records = results["records"]
    lines = ["## Cards", "", READING_CARDS.format(harm=100 * HARM, tune=" --tune" if results["tune"] else ""), ""]
    if results["skipped"]:
        lines += ["SKIPPED: %d JPEG cards: no OpenCV" % len(results["skipped"]), ""]
    lines += header("kind", "cards", "refused", "accepted without a warning", "accepted with a warning",
                    "error of M: median", "worst", "over the frame: median", "worst", "right",
                    "harm without a warning", "harm with a warning", "M(1) within its standard error")
    by_kind = {kind: [r for r in records if r["kind"] == kind] for kind in GOOD + BAD}
    totals = {"all good": sum((by_kind[k] for k in GOOD), []), "all bad": sum((by_kind[k] for k in BAD), [])}
    lines += [card_row(kind, of) for kind, of in {**by_kind, **totals}.items() if of]
    counted = [r for r in records if r["kind"] in GOOD or r["error"] > HARM]
    lines += limit_curves.curves(counted, GOOD, BAD, "cards", ("refusal", "warning", "note"))
    missed = [r for r in records if is_missed(r)]
    if missed:
        lines += ["", "Missed.", "", *header("case", "what", "error of M", "over the frame", "found")]
        lines += [row(r["name"], is_missed(r), number(r["error"]), number(r["frame_error"]),
                      ", ".join("`%s`" % f["code"] for f in r["findings"]) or "nothing") for r in missed]
    return lines + [""]


def card_row(kind, of):
    accepted = [r for r in of if r["usable"]]
    wordless, harmful = count(accepted, lambda r: not r["reason"]), [r for r in accepted if is_harmful(r)]
    figures = [figure for key in ("error", "frame_error")
               for figure in (number(median(accepted, key)), number(max((r[key] for r in accepted), default=None)))]
    silent = count(harmful, lambda r: not r["reason"])
    return row(kind, len(of), len(of) - len(accepted), wordless, len(accepted) - wordless, *figures,
               len(accepted) - len(harmful), silent, len(harmful) - silent,
               held([r["z"] for r in accepted if r["z"] is not None]) if of[0]["kind"] in GOOD else "")
