#!/usr/bin/env bash
# list.sh FILE: the window's texts as gettext's template: those that its source gives to widgets, messages and wr_words. The
# tables' are besides what a walk through the window asks for (tests/test_ui_words.c prints those that a language lacks).
# What a language lacks of them: msgcmp ui/words/de.po FILE
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=$(realpath -m "$1")
cd "$root"
# Lists of X11's names have bytes that are no UTF-8.
mapfile -t files < <(git ls-files 'ui/*.c' 'ui/*.cpp' 2>/dev/null || find ui -name '*.c' -o -name '*.cpp')
kept=()
for file in "${files[@]}"; do
    [[ $file == ui/input/clip_x11.c ]] || kept+=("$file")
done
# xgettext takes one text of an argument: `shown ? "Hide" : "Show"` has two. They get a call of their own.
choices=$(mktemp --suffix=.c)
trap 'rm -f "$choices"' EXIT
perl -0777 -ne '
    while (/\b(?:wr_words|wr_app_say|wr_gui_(?:text|text_wrapped|text_cut|heading|label|tip|button|chip|fold|hold|menu_item|dialog_begin))
            (\((?:[^()"]++|"(?:[^"\\]|\\.)*"|(?1))*\))/gx) {
        my $arguments = $1;
        while ($arguments =~ /[?:]\s*((?:"(?:[^"\\]|\\.)*"\s*)+)/g) {
            my $text = $1;
            print "wr_words($text);\n" if $text =~ /[a-z]{3}/;
        }
    }' "${kept[@]}" >"$choices"
xgettext --language=C --from-code=UTF-8 --no-location --no-wrap -o "$out" \
    -k -kwr_words -kwr_app_say:2 -kwr_gui_text:3 -kwr_gui_text_wrapped:3 -kwr_gui_text_cut:3 -kwr_gui_heading:1 \
    -kwr_gui_label:1 -kwr_gui_tip:1 -kwr_gui_button:1 -kwr_gui_chip:2 -kwr_gui_hint_field:2 -kwr_gui_fold:1 \
    -kwr_gui_menu_begin:1 -kwr_gui_menu_item:1 -kwr_gui_dialog_begin:1 -kwr_gui_draw_text:6 -kROW:2 -kEDIT:2 -kFORM:1 \
    "${kept[@]}" "$choices" 2>/dev/null # it warns of every text with a letter beyond ASCII
