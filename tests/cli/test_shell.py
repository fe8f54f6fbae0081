#!/usr/bin/env python3
"""Man pages and shell completions, checked by the programs that read them, and colour on a terminal.

usage: test_shell.py LENSPROF

mandoc checks the pages; bash completes as if a user pressed tab; zsh and fish check the syntax. Missing programs are
reported as skipped.
"""

import os
import pathlib
import pty
import re
import shutil
import subprocess
import sys
import tempfile

COMPLETE = """
source "$1"
cd "$2"
complete_words() {
  COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=(); _lensprof; printf '%s\\n' "${COMPREPLY[*]}"
}
complete_words lensprof bu
complete_words lensprof profile sh
complete_words lensprof build --repo
complete_words lensprof build --fit lo
complete_words lensprof build --report pi
complete_words lensprof build pi
complete_words lensprof profile show --cha
complete_words lensprof --ver
complete_words lensprof completion ''
complete_words lensprof man bui
complete_words lensprof apply my
complete_words lensprof build --fit loss = ro
complete_words lensprof build --fit loss =
complete_words lensprof build --fit seed=1,loss =
complete_words lensprof build --report = pi
complete_words lensprof help profile sho
complete_words lensprof man profile mer
complete_words lensprof build -- -da
"""
WANTED = ["build", "show", "--report", "loss=", "pictures", "pictures", "--chart --chart-out --channel", "--version",
          "bash zsh fish", "build", "my photo.jpg", "robust", "robust huber squared", "robust huber squared",
          "pictures", "show", "merge", "-dash.jpg"]


def output_of(*words, cwd=None):
    return subprocess.run(words, cwd=cwd, check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True).stdout


def is_there(program):
    if shutil.which(program):
        return True
    print(f"skipped: {program} is not installed (packages-test.txt)")
    return False


def check_pages(lensprof, folder):
    """Every command and verb has a page without warnings, and the page has every option of the help, those of experts
    in a section of their own."""
    output_of(lensprof, "man", "-o", folder)
    pages = sorted(folder.glob("*.1"))
    commands = re.findall(r"^  (\w+) ", output_of(lensprof, "help").partition("Commands:")[2], re.MULTILINE)
    assert len(commands) > 14 and len(pages) > len(commands) + 10, (commands, pages)
    for command in commands:
        text = (folder / f"lensprof-{command}.1").read_text().replace("\\-", "-")
        for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", output_of(lensprof, command, "--help-all"), re.MULTILINE):
            assert option in text, f"lensprof-{command}.1 lacks {option}"
        everyday, _, expert = text.partition(".SH EXPERT OPTIONS")
        assert "--verbose" in expert or command in ("profile",), f"lensprof-{command}.1 lacks expert options"
        for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", output_of(lensprof, "help", command), re.MULTILINE):
            assert option in everyday, f"lensprof-{command}.1 has {option} among those of experts"
    if is_there("mandoc"):
        warnings = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", *pages], stdout=subprocess.PIPE, text=True, check=False)
        assert warnings.returncode == 0, warnings.stdout


def check_bash(lensprof, folder):
    script = folder / "lensprof.bash"
    script.write_text(output_of(lensprof, "completion", "bash"))
    (folder / "pictures").mkdir()
    (folder / "my photo.jpg").touch()
    (folder / "-dash.jpg").touch()
    found = output_of("bash", "-c", COMPLETE, "bash", script, folder).splitlines()
    assert found == WANTED, found


def check_syntax(lensprof, folder):
    for shell in ("bash", "zsh", "fish"):
        script = folder / f"script.{shell}"
        script.write_text(output_of(lensprof, "completion", shell))
        if is_there(shell):
            output_of(shell, "-n", script)


def on_terminal(environment, *words):
    """What a command prints on a terminal."""
    leader, follower = pty.openpty()
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=follower, env={**os.environ, "TERM": "xterm", **environment}):
        pass
    os.close(follower)
    text = b""
    try:
        while part := os.read(leader, 4096):
            text += part
    except OSError:  # Linux: the other end is closed
        pass
    os.close(leader)
    return text


def check_colour(lensprof, folder):
    """Warnings have a colour on a terminal, and on no other."""
    output_of(lensprof, "simulate", "-o", folder / "row", "--images", "4", "--size", "320x240")
    build = [lensprof, "build", folder / "row" / "pano.pto", "--no-store", "--fit", "gamma-from=exif"]
    assert b"\033[1;33mwarning:\033[0m " in on_terminal({"NO_COLOR": ""}, *build)
    for plain in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
        assert b" warning: " in on_terminal(plain, *build)
    piped = subprocess.run(build, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False).stderr
    assert b" warning: " in piped and b"\033" not in piped, piped


def main():
    lensprof = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        check_pages(lensprof, folder)
        check_bash(lensprof, folder)
        check_syntax(lensprof, folder)
        check_colour(lensprof, folder)
    refused = subprocess.run([lensprof, "completion", "tcsh"], stderr=subprocess.PIPE, text=True, check=False)
    assert refused.returncode == 2 and "bash, zsh, fish" in refused.stderr, refused
    print("man pages and completions are right")


if __name__ == "__main__":
    main()
