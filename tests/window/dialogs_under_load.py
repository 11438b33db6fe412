#!/usr/bin/env python3
"""Do file dialogs open while two cores are busy, without a desktop portal?

The program runs under Xvfb, two processes keep two cores busy, and xdotool types without waiting for anything: Ctrl+O (or
Ctrl+Shift+S), at once the path, Enter. A dialog counts as opened when the typed path has done its work: the window's title names
the opened project, or the saved file is there. Nothing typed may reach the tools: no project is changed.

    python3 tests/window/dialogs_under_load.py target/release/lightloom [rounds]
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

program = pathlib.Path(sys.argv[1]).resolve()
rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 50
root = pathlib.Path(__file__).resolve().parents[2]
folder = pathlib.Path(tempfile.mkdtemp(prefix="lightloom-dialogs-"))
display = f":{200 + os.getpid() % 700}"
env = {k: v for k, v in os.environ.items() if k not in ("WAYLAND_DISPLAY", "DBUS_SESSION_BUS_ADDRESS")}
env |= {"DISPLAY": display, "XDG_RUNTIME_DIR": str(folder), "LIGHTLOOM_STATE_DIR": str(folder / "state"),
        "LIGHTLOOM_CONFIG_DIR": str(folder / "config")}
(folder / "config").mkdir()
(folder / "config/preferences.json").write_text('{"first_start_seen": true}')
shutil.copytree(root / "assets/targets", folder / "assets/targets")
(folder / "projects").mkdir()
small = (root / "projects/letters_free.json").read_text()
for i in range(2):
    (folder / f"projects/shot{i}.json").write_text(small)


def tool(*args):
    return subprocess.run(["xdotool", *args], env=env, capture_output=True, text=True).stdout.strip()


def title():
    found = tool("search", "--onlyvisible", "--name", "Lightloom").split()
    return tool("getwindowname", found[0]) if found else ""


def until(holds, seconds=60):
    end = time.time() + seconds
    while time.time() < end:
        if holds():
            return True
        time.sleep(0.1)
    return False


started = [subprocess.Popen(["Xvfb", display, "-screen", "0", "1440x900x24", "-nolisten", "tcp"],
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)]
try:
    time.sleep(1.5)
    started.append(subprocess.Popen([program, folder / "projects/shot0.json"], env=env, stderr=subprocess.DEVNULL))
    assert until(lambda: "shot0" in title()), "no window"
    time.sleep(3)
    tool("windowfocus", tool("search", "--onlyvisible", "--name", "Lightloom").split()[0])
    started += [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    opened, slowest = 0, 0.0
    for i in range(rounds):
        begun = time.time()
        if i % 2 == 0:
            target = folder / f"projects/shot{1 - (i // 2) % 2}.json"
            tool("key", "ctrl+o")
            tool("type", "--delay", "15", str(target))
            tool("key", "Return")
            done = until(lambda: title().startswith(target.name))
        else:
            # Saved under a new name, then again under the old one.
            target = folder / f"projects/saved{i}.json"
            tool("key", "ctrl+shift+s")
            tool("type", "--delay", "15", str(target))
            tool("key", "Return")
            done = until(lambda: target.exists() and title().startswith(target.name))
        opened += done
        slowest = max(slowest, time.time() - begun)
        if not done:
            print(f"round {i}: the title is '{title()}'")
            subprocess.run(["import", "-window", "root", str(folder / f"failed{i}.png")], env=env)
            tool("key", "Escape")
            tool("key", "Escape")
    unchanged = all('"constraints"' not in file.read_text() for file in (folder / "projects").glob("*.json"))
    print(f"{opened} of {rounds} dialogs opened and answered under load, the slowest in {slowest:.1f} s; "
          f"projects {'unchanged' if unchanged else 'CHANGED'} by what was typed; {folder}")
    sys.exit(0 if opened == rounds and unchanged else 1)
finally:
    for process in reversed(started):
        process.kill()
