#!/usr/bin/env bash
# list.sh FILE: writes the window's texts as a gettext template: literals passed to widgets, messages and wr_words, and the
# reasons of the plan. Texts in tables are not found here: tests/ui/test_ui_words.c prints those that a language lacks.
# Texts that a language lacks: msgcmp ui/words/LANGUAGE.po FILE
# list.sh FILE errors: writes the formats of errors and notes in src/ and ui/ (wr_fail and others), except those of
# subcommands without a window and of the hard cases.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=$(realpath -m "$1")
what=${2:-texts}
cd "$root"
if [[ $what == errors ]]; then
    folders=(src ui)
    functions='wr_fail|wr_error_prefix|wr_session_note|wr_message_addf'
    keys=(-kwr_fail:2 -kwr_error_prefix:2 -kwr_session_note:2 -kwr_message_addf:2 -kWR_MESSAGE:1)
else
    folders=(ui src/render/plan)
    functions='say|wr_words|wr_app_say|wr_gui_(?:text|text_wrapped|text_cut|heading|label|tip|button|chip|fold|hold|menu_item|dialog_begin)'
    keys=(-ksay:3 -kwr_words -kwr_app_say:2 -kwr_gui_text:3 -kwr_gui_text_wrapped:3 -kwr_gui_text_cut:3 -kwr_gui_heading:1
        -kwr_gui_label:1 -kwr_gui_tip:1 -kwr_gui_button:1 -kwr_gui_chip:2 -kwr_gui_hint_field:2 -kwr_gui_fold:1
        -kwr_gui_menu_begin:1 -kwr_gui_menu_item:1 -kwr_gui_dialog_begin:1 -kwr_gui_draw_text:6 -kROW:2 -kEDIT:2)
fi
# Lists of X11's names have bytes that are no UTF-8.
mapfile -t files < <(find "${folders[@]}" \( -name '*.c' -o -name '*.cpp' -o -name '*.h' \) ! -name clip_x11.c \
    ! -path 'src/cli/*' ! -path 'src/api/*' ! -path 'src/hardcases/*' | LC_ALL=C sort)
# xgettext takes one text of an argument: `shown ? "Hide" : "Show"` has two. They get a call of their own.
choices=$(mktemp --suffix=.c)
trap 'rm -f "$choices"' EXIT
FUNCTIONS=$functions perl -0777 -ne '
    while (/\b(?:$ENV{FUNCTIONS})
            (\((?:[^()"]++|"(?:[^"\\]|\\.)*"|(?1))*\))/gx) {
        my $arguments = $1;
        # Of a format, only the choice that stands in its place: the other arguments are values.
        $arguments =~ s/^(\([^,]*,(?:[^,"]|"(?:[^"\\]|\\.)*"\s*)*),.*/$1/s if $ENV{FUNCTIONS} =~ /wr_fail/;
        while ($arguments =~ /[?:]\s*((?:"(?:[^"\\]|\\.)*"\s*)+)/g) {
            my $text = $1;
            print "wr_choice($text);\n" if $text =~ /[a-z]{3}/;
        }
    }' "${files[@]}" >"$choices"
xgettext --language=C --from-code=UTF-8 --no-location --no-wrap -o "$out" -k -kwr_choice "${keys[@]}" \
    "${files[@]}" "$choices" 2>/dev/null # it warns of every text with a letter beyond ASCII
