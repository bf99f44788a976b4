#!/usr/bin/env bash
# The Krita plugin as Krita imports and runs it (krita_plugin.py).  krita_plugin.sh BUILD-FOLDER SOURCE-FOLDER
set -uo pipefail
importer=/usr/share/krita/pykrita/plugin_importer
for needed in kritarunner xvfb-run; do
    command -v "$needed" >/dev/null || { echo "krita_plugin: there is no $needed here"; exit 77; }
done
[[ -d $importer ]] || { echo "krita_plugin: this Krita has no importer of plugins"; exit 77; }
/usr/bin/python3 -c 'import PyQt5' 2>/dev/null || { echo "krita_plugin: there is no python3-pyqt5 here"; exit 77; }
home=$(mktemp -d) || exit 1
trap 'rm -rf "$home"' EXIT
mkdir -m 700 "$home/runtime"
mkdir "$home/resources"
export HOME=$home XDG_CONFIG_HOME=$home/config XDG_DATA_HOME=$home/data XDG_RUNTIME_DIR=$home/runtime
export PYTHONDONTWRITEBYTECODE=1 WRINKLE_PROGRAM=$1/wrinkle KRITA_RESULT=$home/result
/usr/bin/python3 - "$importer" "$1/wrinkle-krita.zip" "$home/resources" <<'PYTHON' || exit 1
import builtins
import sys
builtins.i18n = str
sys.path.insert(0, sys.argv[1])
from plugin_importer import PluginImporter
assert len(PluginImporter(sys.argv[2], sys.argv[3], lambda plugin: False).import_all()) == 1
PYTHON
PYTHONPATH=$home/resources/pykrita:$2/tests/ui timeout 120 xvfb-run -a kritarunner -s krita_plugin -f __main__ \
    >"$home/log" 2>&1
cat "$home/result" 2>/dev/null
[[ $(tail -n 1 "$home/result" 2>/dev/null) == passed ]] || { tail -n 20 "$home/log"; exit 1; }
