#!/usr/bin/env bash
# The Krita plugin's files and command lines (test_krita_exchange.py).  krita_exchange.sh PROGRAM SOURCE-FOLDER
set -uo pipefail
export PYTHONDONTWRITEBYTECODE=1
exec /usr/bin/python3 -W error::ResourceWarning "$2/tests/ui/test_krita_exchange.py" "$1" \
    "$2/ui/addons/krita/wrinkle_krita"
