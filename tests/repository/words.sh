#!/usr/bin/env bash
# Every text that the window's source shows has a translation in each language, and one whose arguments are others than the
# English text's is refused.  words.sh SOURCE-FOLDER
set -euo pipefail
source=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

for tool in xgettext msgcmp msgfmt; do
    command -v "$tool" >/dev/null || { echo "$tool is missing: apt-get install gettext"; exit 1; }
done
bash "$source/ui/words/list.sh" all.pot
# Not those without a word, and texts that are put together of others. The head says how texts are written.
awk 'BEGIN { RS = ""; ORS = "\n\n" } NR == 1 { sub(/charset=CHARSET/, "charset=UTF-8") }
     !/msgid "([^A-Za-z"]+|##[a-z]*|%\.\*s|%s: %s|[RSXYZ])"/' all.pot >texts.pot
[[ $(grep -c '^msgid' texts.pot) -gt 500 ]] || { echo "the source was not read: $(grep -c '^msgid' texts.pot) texts"; exit 1; }
lacking=0
for po in "$source"/ui/words/*.po; do
    if ! msgcmp "$po" texts.pot >missing 2>&1; then
        grep -v "not used" missing
        echo "these have no text in $po"
        lacking=1
    fi
    # Other arguments: a text in the place of a number, one too few.
    for change in '/^msgid "%d of %d"$/{n;s/%d/%s/}' '/^msgid "%d of %d"$/{n;s/%d"/x"/}'; do
        sed "$change" "$po" >broken.po
        cmp -s broken.po "$po" && { echo "nothing to break: $change in $po"; exit 1; }
        if msgfmt --check -o broken.mo broken.po 2>/dev/null; then
            echo "a translation with other arguments is taken: $change in $po"
            exit 1
        fi
    done
done
exit $lacking
