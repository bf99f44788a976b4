#!/usr/bin/env bash
# The recipes of src/README.md, followed in a copy with a dummy row: step by step either the compiler stops at the file that the
# recipe names next, or everything compiles. Compiles single files, and only up to their meaning.
#   recipes.sh SOURCE BUILD FOLDER
set -uo pipefail
source=$(cd "$1" && pwd)
# shellcheck source=tests/compile_help.sh
source "$source/tests/compile_help.sh"
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

# ---- a reflection model ----
models=src/shade/reflection_models.h formulas=src/shade/reflection_body.h
kinds=src/shade/reflection.h reference=src/render/reference/reference_shade.c
kernels=(src/render/kernels/kern_v1.c src/render/kernels/kern_double_v1.c)
# Files that have something to do with models: each includes the table, or has a switch.
users=(src/shade/reflection.c src/shade/environment_brdf.c src/render/pipeline/pipeline.c src/render/plan/plan_light.c
    src/render/plan/plan_light.c src/render/plan/plan_light.c src/render/reference/reference_environment.c
    src/command/look_commands.c src/scene/material_preset.c ui/panels/panel_material.c ui/panels/panel_maps.c)

for loops in UNIFORM ROUGH METAL; do
    pristine "$models" "$formulas" "$reference"
    edit "$models" 's/(in glTF"\))\n/$1 X(DUMMY, dummy, '$loops', SMITH, LAMBERT, false, "dummy", "Dummy", "no model")\n/'
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
exit $bad
