#!/bin/sh
# Installs Lightloom for this user, or below the folder that is given: ./install.sh [PREFIX]
set -eu
from=$(cd "$(dirname "$0")" && pwd)
prefix=${1:-"$HOME/.local"}
mkdir -p "$prefix/bin" "$prefix/share"
# In one step, so that a running program keeps its file.
cp "$from/bin/lightloom" "$prefix/bin/.lightloom.new"
mv "$prefix/bin/.lightloom.new" "$prefix/bin/lightloom"
cp -R "$from/share/." "$prefix/share/"
# Desktops that know neither program find the entries by themselves, later.
update-mime-database "$prefix/share/mime" 2>/dev/null || true
update-desktop-database "$prefix/share/applications" 2>/dev/null || true
echo "installed as $prefix/bin/lightloom"
case ":$PATH:" in *":$prefix/bin:"*) ;; *) echo "add $prefix/bin to PATH to start it by name" ;; esac
