#!/usr/bin/env bash
# Each form of an error that the window says in other words (ui/toolkit/sentences.c) is one that some text of the source has, or that
# the system says. A form that no text fits any more is named.  sentences.sh SOURCE-FOLDER
set -euo pipefail
source=$1
command -v perl >/dev/null || { echo "perl is missing: apt-get install perl"; exit 1; }
cd "$source"
find src -name '*.c' -o -name '*.cpp' -o -name '*.h' | sort | perl -e '
use strict;
use Errno;
my (%text, @forms);
# The texts of a file: those that stand one after the other joined, %s in the place of every conversion.
sub texts_of {
    my ($file) = @_;
    local $/;
    open my $from, "<", $file or die "$file: $!\n";
    my ($all, @found) = (scalar <$from>);
    while ($all =~ /((?:"(?:[^"\\\n]|\\.)*"\s*(?:PRI\w+\s*)?)+)/g) {
        my $text = $1;
        $text =~ s/PRI\w+//g;
        $text = join "", $text =~ /"((?:[^"\\]|\\.)*)"/g;
        $text =~ s/%[-+ #0-9.*]*(?:hh|h|ll|l|z|t|j)?[a-zA-Z]/%s/g;
        push @found, $text;
    }
    return @found;
}
while (my $file = <STDIN>) { chomp $file; $text{$_} = 1 for texts_of($file); }
for my $number (qw(ENOENT EACCES EISDIR ENOTDIR ENOSPC EROFS ENAMETOOLONG)) { $! = Errno->can($number)->(); $text{"$!"} = 1; }
{ local $/; open my $from, "<", "ui/toolkit/sentences.c" or die; @forms = <$from> =~ /FORM\("((?:[^"\\]|\\.)*)"\)/g; }
die "the source was not read\n" unless @forms > 60 && keys %text > 1500;
# A text fits whole; or what follows a colon of it, or tells what would be right; or it is what comes before the last part. Or all
# that stands between parts are texts, of which such a sentence is put together.
my $lost = 0;
for my $form (@forms) {
    my @pieces = split /%s/, $form, -1;
    my $want = join ".+", map { quotemeta } @pieces;
    my ($longest) = sort { length $b <=> length $a } @pieces;
    next if grep { index($_, $longest) >= 0 && /(?:^|: |must be )$want$/ } keys %text;
    next if $form =~ /^(.+)%s$/ && $text{$1};
    next if !grep { $_ ne "" && !$text{$_} } @pieces;
    print "no text of the source fits the form \"$form\" of ui/toolkit/sentences.c\n";
    $lost = 1;
}
exit $lost;
'
