# compile_help.sh - for scripts that change sources in a copy and ask the compiler about single files. Sourced.

# scratch_tree SOURCE BUILD FOLDER: copies src, ui and tests/bench to $tree, and writes the commands of BUILD for files of the copy,
# without output, to $folder/commands: FILE TAB COMMAND. A compilation that the build writes (wr_kern of CMakeLists.txt) is named as
# if its text lay in SOURCE: src/noise/wr_noise_kernels_v3.c.
scratch_tree() {
    local build
    build=$(cd "$2" && pwd) && mkdir -p "$3" && folder=$(cd "$3" && pwd) || return 1
    tree=$folder/tree
    rm -rf "$tree" && mkdir -p "$tree" || return 1
    (cd "$1" && find src ui tests/bench -name '*.[ch]' -print0 | tar -c --null -T -) | tar -x -C "$tree" || return 1
    SOURCE=$1 BUILD=$build TREE=$tree perl -MJSON::PP -0777 -ne '
        for my $e (@{ decode_json($_) }) {
            my ($file, $command) = ($e->{file}, $e->{command});
            $file =~ s/^\Q$ENV{BUILD}\E\/// or $file =~ s/^\Q$ENV{SOURCE}\E\/// or next;
            $command =~ s/ -o \S+ / /;
            $command =~ s/\Q$ENV{SOURCE}\E\/(src|ui|tests)\b/$ENV{TREE}\/$1/g;
            $command =~ s/-I\Q$ENV{SOURCE}\E(?=\s)/-I$ENV{TREE}/g;
            print "$file\tcd $e->{directory} && $command -fsyntax-only -Werror\n";
        }' "$build/compile_commands.json" >"$folder/commands"
    export folder
    [[ -s $folder/commands ]]
}

# Writes the messages of the compiler about a file to $folder/said/FILE; the last line of a file that does not compile is
# "it stopped".
# shellcheck disable=SC2317  # called by xargs
try() {
    local command said=$folder/said/${1//\//_}
    command=$(awk -F '\t' -v f="$1" '$1 == f { print $2; exit }' "$folder/commands")
    [[ -n $command ]] || { echo "no command for $1" >"$said"; return; }
    CCACHE_DISABLE=1 LC_ALL=C bash -c "$command" >"$said" 2>&1 || echo 'it stopped' >>"$said"
}
export -f try

# try_all FILE...: all of them, on all processors.
try_all() {
    rm -rf "$folder/said" && mkdir "$folder/said" || exit 1
    # shellcheck disable=SC2016  # for the shell that is started
    printf '%s\n' "$@" | sort -u | xargs -P "$(nproc)" -I {} bash -c 'try "$1"' try {}
}
