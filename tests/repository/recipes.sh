#!/usr/bin/env bash
# The recipes of src/README.md, followed in a copy with a dummy row: step by step either the compiler stops at the file that the
# recipe names next, or everything compiles. Compiles single files, and only up to their meaning; the panel's are linked too.
#   recipes.sh SOURCE BUILD FOLDER
set -uo pipefail
source=$(cd "$1" && pwd) build=$(cd "$2" && pwd)
# shellcheck source=tests/repository/compile_help.sh
source "$source/tests/repository/compile_help.sh"
scratch_tree "$source" "$2" "$3" || { echo "recipes: $2/compile_commands.json has no commands"; exit 1; }
bad=0
wrong() {
    printf 'recipes: %s\n' "$*"
    bad=1
}

# edit FILE PERL: changes a file of the copy; the expression returns false where it found nothing to change.
edit() {
    perl -0pi -e "($2) or die \"nothing to change\\n\"" "$tree/$1" 2>"$folder/edit" || wrong "$1: $(cat "$folder/edit")"
}
# Back to the sources as they are: pristine FILE...
pristine() {
    local file
    for file in "$@"; do cp "$source/$file" "$tree/$file"; done
}
# stops WHAT MESSAGE FILE...: the compiler stops at each of them, with that message.
stops() {
    local what=$1 message=$2 file said
    shift 2
    try_all "$@"
    for file in "$@"; do
        said=$folder/said/${file//\//_}
        if ! grep -q 'it stopped' "$said"; then wrong "$what: $file compiles"
        elif ! grep -qE "$message" "$said"; then wrong "$what: $file: $(grep -m 2 error "$said")"
        else printf '%s: %s stops\n' "$what" "$file"; fi
    done
}
# compile WHAT FILE...
compile() {
    local what=$1 file said
    shift
    try_all "$@"
    for file in "$@"; do
        said=$folder/said/${file//\//_}
        if [[ -s $said ]]; then wrong "$what: $file: $(grep -m 2 error "$said")"
        else printf '%s: %s compiles\n' "$what" "$file"; fi
    done
}

# like OLD NEW: a file of the copy that no list has yet is compiled as another is.
like() {
    sed -n "\\|^$1\t|{s|$1|$2|gp;q}" "$folder/commands" >"$folder/like" && cat "$folder/like" >>"$folder/commands"
}
# links WHAT MESSAGE FILE...: the tests of the window with these files of the copy in place of its own: does not link, with that message, or
# links where the message is empty.
links() {
    local what=$1 message=$2 file command objects=() said=$folder/link
    shift 2
    for file in "$@"; do
        command=$(awk -F '\t' -v f="$file" '$1 == f { print $2; exit }' "$folder/commands")
        objects+=("$folder/${file//\//_}.o")
        CCACHE_DISABLE=1 bash -c "${command/-fsyntax-only/-o ${objects[-1]}}" || wrong "$what: $file"
    done
    command=$(ninja -C "$build" -t commands run_ui | tail -1)
    (cd "$build" && LC_ALL=C timeout 120 bash -c "${command/-o run_ui/${objects[*]} -o $folder/program}") >"$said" 2>&1
    case $?:$message in
    0:) printf '%s: links\n' "$what" ;;
    124:* | 0:* | *:) wrong "$what: $(tail -1 "$said")" ;;
    *) if grep -qE "$message" "$said"; then printf '%s: does not link\n' "$what"; else wrong "$what: $(tail -1 "$said")"; fi ;;
    esac
}

# ---- a reflection model ----
models=src/shade/reflection_models.h formulas=src/shade/reflection_body.h
kinds=src/shade/reflection.h reference=src/render/reference/reference_shade.c
kernels=(src/render/wr_kern_ref.c src/render/wr_kern_double_ref.c)
# Files that have something to do with models: each includes the table, or has a switch.
users=(src/shade/reflection.c src/shade/environment_brdf.c src/render/pipeline/pipeline.c src/render/plan/plan_light.c
    src/render/plan/plan_light.c src/render/plan/plan_light.c src/render/reference/reference_shade.c
    src/command/material_command.c src/scene/material_preset.c ui/panels/panel_material.c ui/panels/panel_maps.c)

for loops in UNIFORM ROUGH METAL; do
    pristine "$models" "$formulas" "$reference"
    edit "$models" 's|(    X\(GGX, )|    X(DUMMY, dummy, '$loops', SMITH, LAMBERT, false, "dummy", "Dummy", "no model") \\\n$1|'
    stops "model with its row alone, $loops" 'reflect_dummy' "${kernels[@]}"
    stops "model with its row alone, $loops" "‘dummy’|'dummy'" "$reference"
    edit "$formulas" '$_ .= "R_INLINE Reflected reflect_dummy(Incidence at, Form form, const MATTER *m)
        { return form.kept ? reflect_ggx(at, form, m) : reflect_phong(at, form, m); }\n"'
    edit "$reference" 's/(#define CASE_STAGES)/static void dummy(const WrMatter *m, WrEnergy energy, const Incidence *at,
        double own[3], double *white) { ggx(m, energy, at, own, white); }\n$1/'
    compile "model with its row and formulas, $loops" "${kernels[@]}" "$reference" "${users[@]}"
done
pristine "$models" "$formulas" "$reference"

edit "$kinds" 's/(WR_HIGHLIGHT_SMITH) /WR_HIGHLIGHT_DUMMY, $1 /'
stops 'kind of highlight' 'not handled in switch' src/shade/reflection.c src/shade/environment_brdf.c \
    src/render/pipeline/pipeline.c src/render/pipeline/pipeline_double.c
pristine "$kinds"
edit "$kinds" 's/(WR_DIFFUSE_REMAINDER) /WR_DIFFUSE_DUMMY, $1 /'
stops 'kind of diffuse light' 'not handled in switch' src/shade/reflection.c src/shade/environment_brdf.c
pristine "$kinds"
pristine "$kinds"

# users_of PATTERN: the compiled files that say it, which must still compile with one more row.
users_of() {
    (cd "$source" && grep -rlE --include='*.c' "$1" src ui)
}

# ---- a surface ----
list=src/surface/surface_list.h prices=src/accuracy/tolerance_cost.c
edit "$list" 's/(WR_X\(terrain\)\n)/$1WR_X(dummy)\n/'
edit "$list" 's/(#include "surface\/terrain_row.h"\n)/$1#include "surface\/dummy.h"\n/'
stops 'surface with its list alone' 'dummy' src/surface/surface.c "${kernels[@]}"
sed 's/torus/dummy/g' "$source/src/surface/torus.h" >"$tree/src/surface/dummy.h"
stops 'surface without a price' 'not a row for each' "$prices"
edit "$prices" 's/(static const double surface_price\[\] = \{\n)/$1 [WR_ROW(WR_SURFACE_dummy)] = 30,\n/'
# shellcheck disable=SC2046  # a list of files
compile 'surface' "$prices" src/surface/surface.c "${kernels[@]}" $(users_of 'wr_surfaces\b|WR_SURFACE_COUNT')
pristine "$list" "$prices"

# ---- a light ----
scene=src/scene/scene.h rows=src/scene/scene.c
edit "$scene" 's/(WR_LIGHT_POINT, )/$1WR_LIGHT_DUMMY, /'
stops 'light without a row' 'not a row for each' "$rows"
edit "$rows" 's/(\[WR_ROW\(WR_LIGHT_POINT\)\])/[WR_ROW(WR_LIGHT_DUMMY)] = { "dummy", "Dummy", "no light", false },\n$1/'
# shellcheck disable=SC2046
compile 'light' "$rows" $(users_of 'WR_LIGHT_|wr_light_kinds')
pristine "$scene" "$rows"

# ---- an environment ----
maps=src/shade/environment_map.h light=src/shade/environment_map.c
edit "$maps" 's/(    X\(SKY, )/    X(DUMMY, "dummy", "Dummy", dummy) \\\n$1/'
stops 'environment with its row alone' 'dummy' "$light"
edit "$light" 's/(typedef void Light\()/static void dummy(WrVec3 d, double rgb[3]) { studio(d, rgb); }\n$1/'
# shellcheck disable=SC2046
compile 'environment' "$light" $(users_of 'WR_ENVIRONMENT_MAP|wr_environment_map_')
pristine "$maps" "$light"

# ---- a pattern ----
patterns=src/generate/pattern.c declared=src/generate/pattern.h
edit "$patterns" 's/(    ROW\(stripes, )/    ROW(dummy, "Dummy", "no pattern", "replace"),\n$1/'
stops 'pattern with its row alone' 'dummy' "$patterns"
edit "$declared" 's/(WR_PATTERN\(stripes\);\n)/$1WR_PATTERN(dummy);\n/'
compile 'pattern' "$patterns"
pristine "$patterns" "$declared"

# ---- a brush mode ----
modes=src/brush/brush.h work=src/brush/mode.c
edit "$modes" 's/(    WR_BRUSH_MODE_COUNT\n)/    WR_BRUSH_DUMMY,\n$1/'
stops 'brush mode without a row' 'not a row for each' "$work"
edit "$work" 's/(\[WR_ROW\(WR_BRUSH_LIFT\)\])/[WR_ROW(WR_BRUSH_DUMMY)] = { "dummy", "Dummy", "nothing", false, 0, 0.1, WORK(.cover = cover_dummy) },\n$1/'
stops 'brush mode without a function' 'cover_dummy' "$work"
edit "$work" 's/(static void cover_cut\()/static void cover_dummy(const WrModeArgs *args, const float *start, const float *part,
    const float *target, int count, float *out) { cover_target(args, start, part, target, count, out); }\n$1/'
edit "$work" 's/(static void cover_lift\()/static void cover_target(const WrModeArgs *, const float *, const float *, const float *, int, float *);\n$1/'
# shellcheck disable=SC2046
compile 'brush mode' "$work" $(users_of 'WR_BRUSH_[A-Z]+\b|wr_brush_modes')
pristine "$modes" "$work"

# ---- an export ----
kinds=src/export/kinds.c count=src/export/export.h
edit "$kinds" 's/(    \{ \.name = "slopes",)/    { .name = "dummy", .label = "dummy", .help = "nothing", .options = { DEPTH }, .channels = 1,
      .rows = wr_export_dummy_rows, .describe = wr_export_height_describe },\n$1/'
stops 'export with its row alone' 'wr_export_dummy_rows|counts them' "$kinds"
edit "$kinds" 's/wr_export_dummy_rows/wr_export_height_rows/'
stops 'export that is not counted' 'counts them' "$kinds"
edit "$count" 's/(#define WR_EXPORT_KIND_COUNT) (\d+)/"$1 " . ($2 + 1)/e'
# shellcheck disable=SC2046
compile 'export' "$kinds" $(users_of 'WR_EXPORT_KIND_COUNT')
pristine "$kinds" "$count"

# ---- a panel ----
registry=ui/app/registry_list.c panels=ui/panels/panels.h
edit "$registry" 's/(\{ "Plan", )/{ "Dummy", .draw = wr_panel_dummy },\n$1/'
stops 'panel with its row alone' 'wr_panel_dummy' "$registry"
edit "$panels" 's/(void wr_panel_plan\()/void wr_panel_dummy(WrApp *app);\n$1/'
sed 's/wr_panel_plan/wr_panel_dummy/' "$source/ui/panels/panel_plan.c" >"$tree/ui/panels/panel_dummy.c"
like ui/panels/panel_plan.c ui/panels/panel_dummy.c
compile 'panel' "$registry" ui/panels/panel_dummy.c
links 'panel whose file is in no list' 'undefined.*wr_panel_dummy' "$registry"
links 'panel' '' "$registry" ui/panels/panel_dummy.c
rm "$tree/ui/panels/panel_dummy.c"
pristine "$panels" "$registry"
exit $bad
