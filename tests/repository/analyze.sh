#!/usr/bin/env bash
# Other compilers and static analysis: bash tests/repository/analyze.sh gcc|tidy|clang [BUILD-FOLDER]
#
#   gcc    -fanalyzer of GCC 12, every C file of src and ui
#   tidy   clang-tidy 19 with the checks of .clang-tidy, every file of src and ui
#   clang  clang 19 and clang 14 build everything without a warning, and their programs write the bytes that BUILD-FOLDER's does
#
# BUILD-FOLDER (build) is a finished build, from which flags and generated headers are taken. A warning fails unless the table
# below has it, and so does a row of the table that nothing needs. ANALYZE_ONLY=src/base: only files whose names begin so.
# Exit status 77: the tool is not installed.
set -uo pipefail

# TOOL FILE CHECK NUMBER: REASON
kept='
gcc src/base/memory.c -Wanalyzer-malloc-leak 1: the block is kept in the header before the aligned address, which is computed
gcc src/document/document_file.c -Wanalyzer-null-dereference 2: a part that belongs to a layer follows one
gcc src/export/film.c -Wanalyzer-null-dereference 1: check() refuses a film of no kind
gcc src/export/map_sets.c -Wanalyzer-null-argument 1: a contact sheet has a name
gcc src/generate/svg_path.c -Wanalyzer-null-dereference 1: a list with a count above 0 has memory
gcc src/hardcases/hardcases.c -Wanalyzer-null-dereference 1: each number of a case has its row
tidy src/accuracy/tolerance.c clang-analyzer-core.NullDereference 1: a choice by a tolerance has one
tidy src/base/file.c clang-analyzer-core.NullDereference 1: a list with a count above 0 has memory
tidy src/base/file.c misc-redundant-expression 1: a removal that failed is tried a second time
tidy src/base/text.c clang-analyzer-core.UndefinedBinaryOperatorResult 2: both words have as many letters as were counted
tidy src/cli/cmd_inspect.c clang-analyzer-core.CallAndMessage 4: parse_point sets both, or fails
tidy src/cli/completion.c clang-analyzer-core.NonNullParamChecker 1: each option has a name
tidy src/command/generator_layers.c clang-analyzer-core.uninitialized.Assign 1: as many were stored as the call has arguments
tidy src/command/selection_commands.c clang-analyzer-core.UndefinedBinaryOperatorResult 2: find_moved sets the list, or fails
tidy src/command/session.c clang-analyzer-core.uninitialized.Assign 1: find_layer sets the index, or fails
tidy src/command/session_picture.c clang-analyzer-core.NonNullParamChecker 1: a linear picture has floats
tidy src/document/document.c clang-analyzer-core.UndefinedBinaryOperatorResult 1: there is an entry for each layer
tidy src/document/document.c clang-analyzer-core.uninitialized.ArraySubscript 1: there is an entry for each layer
tidy src/document/history.c clang-analyzer-core.NullDereference 1: each state has a document
tidy src/document/recover.c clang-analyzer-core.NonNullParamChecker 2: a reader that has bytes has a buffer
tidy src/export/film.c bugprone-suspicious-missing-comma 2: PALETTE is joined of two texts
tidy src/export/glb.c clang-analyzer-core.NullDereference 1: without triangles of its own it takes those of the scene, which has some
tidy src/export/line_drawing.c clang-analyzer-core.uninitialized.Assign 1: a drawing that was made is set as a whole
tidy src/export/solid.c clang-analyzer-core.NullDereference 1: a list with a count above 0 has memory
tidy src/export/solid.c clang-analyzer-core.UndefinedBinaryOperatorResult 1: both ends of a side have a location
tidy src/field/horizon.c clang-analyzer-core.UndefinedBinaryOperatorResult 1: each direction has its sine
tidy src/field/ops_build.c clang-analyzer-core.NonNullParamChecker 1: a row to compare has been made
tidy src/field/select_shape.c clang-analyzer-core.CallAndMessage 2: select_vertex sets both, or fails
tidy src/field/select_shape.c clang-analyzer-core.NullDereference 1: a loop has a first point
tidy src/generate/rim_generators.c clang-analyzer-core.NullDereference 1: one of the two lists has a piece left
tidy src/generate/solid_generators.c clang-analyzer-core.uninitialized.ArraySubscript 1: the net begins without points
tidy src/generate/solid_places.c clang-analyzer-core.uninitialized.Assign 1: what makes the points sets their count, or fails
tidy src/generate/text_generators.c clang-analyzer-core.CallAndMessage 1: as many names are told as were lent
tidy src/generate/text_relief.c clang-analyzer-core.NullDereference 1: a list with a count above 0 has memory
tidy src/generate/text_relief.c clang-analyzer-core.uninitialized.Assign 1: distances are found for wanted texels
tidy src/image/exr.c clang-analyzer-core.CallAndMessage 1: a part that was added has an index
tidy src/image/font_load.c bugprone-signed-char-misuse 1: levels of FriBidi are not negative
tidy src/image/font_load.c clang-analyzer-core.NonNullParamChecker 1: a font has a glyph
tidy src/image/font_load.c clang-analyzer-core.NullDereference 2: a font that was opened has a face; lines are asked for
tidy src/image/font_outline.c clang-analyzer-core.CallAndMessage 7: each verb takes its number of points
tidy src/image/gltf_mesh.c clang-analyzer-core.NullDereference 1: an accessor with a count above 0 has bytes
tidy src/image/mesh_readers.c clang-analyzer-core.uninitialized.Assign 2: numbers are set, or reading fails
tidy src/noise/noise.c clang-analyzer-core.UndefinedBinaryOperatorResult 2: noise has one to three dimensions, and a slope in each
tidy src/noise/noise.c clang-analyzer-core.uninitialized.Assign 1: noise has one to three dimensions, and a slope in each
tidy src/noise/noise.c clang-analyzer-core.uninitialized.UndefReturn 1: noise has one to three dimensions
tidy src/noise/octaves.c clang-analyzer-core.UndefinedBinaryOperatorResult 1: octaves set a slope in each dimension
tidy src/render/frame/adaptive.c clang-analyzer-core.uninitialized.Assign 2: pairs and rows of pixels are not empty
tidy src/render/pipeline/pipeline_body.h misc-redundant-expression 1: one text in two precisions
tidy src/render/reference/reference.c clang-analyzer-core.NullDereference 1: a looker has a scene
tidy src/render/tessellation/dice.c clang-analyzer-core.NonNullParamChecker 1: each face has its rates
tidy src/render/visibility/view.c clang-analyzer-core.UndefinedBinaryOperatorResult 2: each face of the shape is facing or not
tidy src/scene/objects.c clang-analyzer-core.UndefinedBinaryOperatorResult 1: wr_scene_place sets the place, or fails
tidy src/scene/objects.c clang-analyzer-core.uninitialized.Branch 1: wr_scene_place sets the place, or fails
tidy src/surface/patches.c clang-analyzer-core.UndefinedBinaryOperatorResult 2: read_whole sets the number, or fails
tidy src/surface/projection.c clang-analyzer-core.UndefinedBinaryOperatorResult 1: the first angle is set before others follow it
tidy src/surface/uv_coverage.c clang-analyzer-core.uninitialized.Assign 1: maps have one to three channels
tidy src/system/linux.c bugprone-unsafe-functions 1: vfork is needed for a child that dies with its parent; signals are blocked around it
tidy src/system/linux.c clang-analyzer-security.insecureAPI.vfork 1: needed for a child that dies with its parent; signals are blocked around it
tidy src/system/linux.c clang-analyzer-unix.Vfork 1: the child calls what may be called between fork and exec, and ends
tidy src/system/path.c clang-analyzer-unix.StdCLibraryFunctions 4: the folder is open, so that dirfd has a descriptor
tidy ui/canvas/canvas.c clang-analyzer-core.CallAndMessage 1: one field, or both, are set
tidy ui/input/pen_curve.c clang-analyzer-core.CallAndMessage 1: a curve that is valid has two points or more
tidy ui/input/pen_curve.c clang-analyzer-core.UndefinedBinaryOperatorResult 3: a curve that is valid has two points or more
tidy ui/input/pen_record.c clang-analyzer-core.CallAndMessage 1: number_of sets the number, or fails
tidy ui/panels/generate/generate_state.c clang-analyzer-core.NullDereference 1: a call has a generator
tidy ui/panels/help/guide.c clang-analyzer-core.CallAndMessage 1: a file that was read has its text
tidy ui/panels/panel_plan.c clang-analyzer-core.CallAndMessage 1: the last of the beginnings is empty, so that one fits
tidy ui/panels/panel_right.c clang-analyzer-core.UndefinedBinaryOperatorResult 1: a floating tab has its place
'

root=$(CDPATH='' cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.." && pwd -P)
build=$(CDPATH='' cd -- "${2:-$root/build}" && pwd -P) || exit 1
only=${ANALYZE_ONLY:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C CCACHE_DISABLE=1 root work
say() { printf 'analyze: %s\n' "$*"; }
need() { command -v "$1" >/dev/null || { say "$1 is missing: apt-get install $1"; exit 77; }; }

# Prints FILE TAB FLAGS for the files of src and ui: folders, macros and language of the build, no flag that only one compiler knows.
# Assertions are on, since the analysis believes them. Kernels are left out: they are many compilations of one text.
files() {
    ROOT=$root ONLY=$only perl -MJSON::PP -0777 -ne '
        my %seen;
        for my $entry (@{ decode_json($_) }) {
            my ($name) = $entry->{file} =~ m{^\Q$ENV{ROOT}\E/((?:src|ui)/.*\.(?:c|cpp))$} or next;
            next if $seen{$name}++ || index($name, $ENV{ONLY}) != 0;
            my ($flags) = $entry->{command} =~ /^\S*(?:ccache )?\S+ (.*)/;
            my @kept = grep { $_ ne "-DNDEBUG" } $flags =~ /((?:-isystem |-I|-D|-std=)(?:\\.|[^\s\\])+)/g;
            print "$name\t@kept\n";
        }' "$build/compile_commands.json" | sort
}

# Runs `each FILE FLAGS` for the names that match; what they print goes to $work/said.
run_each() {
    files | grep -E "^\S+\.$1"$'\t' >"$work/files"
    [[ -s $work/files ]] || { say "$build/compile_commands.json has no files of $root/$only"; exit 1; }
    # shellcheck disable=SC2016  # for the shell that is started
    tr '\n' '\0' <"$work/files" |
        xargs -0 -P "$(nproc)" -I {} bash -c 'each "${1%%$'"'\t'"'*}" "${1#*$'"'\t'"'}"' each {} >"$work/said" 2>&1
    say "$(wc -l <"$work/files") files in $SECONDS s"
}

# Compares the warnings in $work/said with the table. Errors count too: the rest of such a file was not looked at.
compare() {
    TOOL=$1 KEPT=$kept ONLY=$only perl -e '
        my (%kept, %found, %seen, $bad);
        for (grep /\S/, split /\n/, $ENV{KEPT}) {
            my ($tool, $file, $check, $number) = /^(\S+) (\S+) (\S+) (\d+): \S/ or die "analyze: not a row of the table: $_\n";
            $kept{"$file: $check"} = $number if $tool eq $ENV{TOOL} && index($file, $ENV{ONLY}) == 0;
        }
        while (<>) {
            s/^\Q$ENV{root}\E\///;
            next if $seen{$_}++ || !/^(?:([^\s:]+):\d+:\d+|(\S+)): (?:warning|(?:fatal )?error): /;
            my $file = $1 // $2;
            my $check = /\[([^\][]+)\]$/ ? $1 : "error";
            push @{ $found{"$file: $check"} }, $_;
        }
        for (sort keys %{ { %found, %kept } }) {
            my ($number, $allowed) = (scalar @{ $found{$_} // [] }, $kept{$_} // 0);
            next if $number == $allowed;
            print "analyze: $_: $number, and the table has $allowed\n", map { "    $_" } @{ $found{$_} // [] };
            $bad = 1;
        }
        exit($bad // 0)' "$work/said"
}

case ${1:-} in
gcc)
    need gcc-12
    # GCC 12 does not follow arrays that loops fill: clang-tidy and valgrind look for values that nobody set.
    # shellcheck disable=SC2086,SC2317  # words; called by xargs
    each() { gcc-12 ${2//\\\"/\"} -O1 -fanalyzer -Wno-analyzer-use-of-uninitialized-value -fno-diagnostics-show-caret -fdiagnostics-path-format=none -c -o /dev/null "$root/$1"; }
    export -f each
    run_each c
    compare gcc
    ;;
tidy)
    need clang-tidy-19
    # shellcheck disable=SC2086,SC2317
    each() { clang-tidy-19 --quiet "$root/$1" -- ${2//\\\"/\"}; }
    export -f each
    run_each 'c(pp)?'
    compare tidy
    ;;
clang)
    # Heights and a picture of each sample, made by one program.
    samples() {
        local sample name
        mkdir "$2" && cd "$2" || exit 1
        for sample in "$root"/samples/*.wrinkle; do
            name=$(basename "$sample" .wrinkle)
            "$1" render "$sample" -o "$name.exr" --size 128x128 || say "$sample: render by $1 failed"
            "$1" export "$sample" --as height -o "$name.r32" || say "$sample: export by $1 failed"
        done >>"$work/samples.log" 2>&1
    }
    unset CCACHE_DISABLE
    for version in 19 14; do
        need "clang-$version"
    done
    (samples "$build/wrinkle" "$work/samples")
    bad=0
    for version in 19 14; do
        folder=$work/clang-$version
        if ! { cmake -S "$root" -B "$folder" -G Ninja -DCMAKE_C_COMPILER="clang-$version" -DCMAKE_CXX_COMPILER="clang++-$version" \
                -DWR_WERROR=ON -DWR_TESTS=ON -DWR_KERNELS=native && cmake --build "$folder" -- -k 0; } >"$work/log" 2>&1; then
            grep -E '(error|warning): |^CMake Error' "$work/log" | sort -u
            say "clang-$version: the build fails"
            bad=1
            continue
        fi
        (samples "$folder/wrinkle" "$folder/samples")
        diff -r "$work/samples" "$folder/samples" || { say "clang-$version: other bytes than $build/wrinkle"; bad=1; }
        say "clang-$version: $SECONDS s"
    done
    ! grep '^analyze: ' "$work/samples.log" || bad=1
    exit $bad
    ;;
*)
    say 'expected gcc, tidy or clang'
    exit 2
    ;;
esac
