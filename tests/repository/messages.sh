#!/usr/bin/env bash
# Formats of errors and notes (base/message.h) that a language lacks are named, texts of formats that the source no longer
# has, and such rows of the window's plain errors.  messages.sh SOURCE-FOLDER
set -euo pipefail
source=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

for tool in xgettext msgcomm msggrep perl; do
    command -v "$tool" >/dev/null || { echo "$tool is missing: apt-get install gettext perl"; exit 1; }
done
bash "$source/ui/words/list.sh" "$folder/errors.pot" errors
bash "$source/ui/words/list.sh" "$folder/texts.pot"
for name in errors texts; do
    sed -i 's/charset=CHARSET/charset=UTF-8/' "$folder/$name.pot"
    msgattrib --no-wrap --force-po "$folder/$name.pot" -o "$folder/$name.po"
done
languages=()
for po in "$source"/ui/words/*.po; do
    languages+=("$(basename -s .po "$po")")
    msgattrib --no-wrap "$po" -o "$folder/${languages[-1]}.po"
done
perl -e '
use strict;
my ($folder, $source, @languages) = @ARGV;
# The keys of a file whose lines are not wrapped; those with a context are left out.
sub keys_of {
    my ($name) = @_;
    local $/ = "";
    open my $from, "<", "$folder/$name.po" or die "$name: $!\n";
    my @keys;
    while (my $entry = <$from>) { push @keys, $1 if $entry !~ /^msgctxt/m && $entry =~ /^msgid "(.+)"$/m; }
    return @keys;
}
my %errors = map { $_ => 1 } keys_of("errors");
die "the source was not read\n" unless keys %errors > 700 && @languages;
my %texts = map { $_ => 1 } keys_of("texts");
my $wrong = 0;
# xgettext ends a text at a macro: its translation has it whole.
sub begins {
    my ($start, @all) = @_;
    return grep { $_ eq $start || ($start =~ /[ "]$/ && index($_, $start) == 0) } @all;
}
for my $language (@languages) {
    my @keys = keys_of($language);
    my @lacking = sort grep { !begins($_, @keys) && s/%[-+ #0-9.*]*(?:hh|ll|[hlzjt])?[a-zA-Z]//gr =~ /[a-z]{3}/ } keys %errors;
    print map { "ui/words/$language.po has no \"$_\"\n" } @lacking;
    printf "%d formats of errors and notes, %d missing in %s\n", scalar keys %errors, scalar @lacking, $language;
    open my $from, "<", "$folder/$language.po" or die;
    my $all = join "", <$from>;
    $all =~ s/.*# Formats of errors and notes[^\n]*\n//s or die "$language.po has no part for errors\n";
    my @old = grep { my $key = $_; !$texts{$key} && !grep { begins($_, $key) } keys %errors }
        map { /^msgid "(.+)"$/m && !/^msgctxt/m ? $1 : () } split /\n\n/, $all;
    print map { "no error or note of the source has the format \"$_\" of ui/words/$language.po\n" } @old;
    $wrong += @lacking + @old;
}
open my $plain, "<", $source or die "$source: $!\n";
my ($rows) = join("", <$plain>) =~ /plains\[\] = \{\n(.*?)\n\};/s or die "the plain errors were not read\n";
my @plains = map { join "", /"((?:[^"\\]|\\.)*)"/g } $rows =~ /^    \{ ((?:"(?:[^"\\]|\\.)*"\s*)+),/mg;
my @stale = grep { !$errors{$_} } @plains;
die "the plain errors were not read\n" unless @plains > 10;
print map { "no error of the source has the format \"$_\" of $source\n" } @stale;
exit($wrong + @stale > 0);
' "$folder" "$source/ui/app/state/plain_error.c" "${languages[@]}"
