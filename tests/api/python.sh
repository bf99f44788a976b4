#!/usr/bin/env bash
# The Python package as installed (test_python.py).  python.sh BUILD-FOLDER SOURCE-FOLDER
set -uo pipefail
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
cmake --install "$1" --prefix "$folder/prefix" >log 2>&1 || { cat log; exit 1; }
mv prefix moved
export PYTHONPATH=$folder/moved/lib/python3/dist-packages WRINKLE_SOURCE=$2 PYTHONDONTWRITEBYTECODE=1
exec /usr/bin/python3 -W error::ResourceWarning "$2/tests/api/test_python.py"
