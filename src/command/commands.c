/* The table itself. */
#include "command/args.h"

#include <string.h>

const char *const wr_class_names[] = { "edit", "scene", "view", "output", "history" };

const WrCommand wr_commands[] = {
    { .name = "table",
      .kind = WR_CLASS_EDIT,
      .args = wr_args_table,
      .run = wr_run_table,
      .help = "a new height table, everywhere 0",
      .details = "It has one layer, and nothing is selected.",
      .example = "table 512x256 wrap=clamp-v" },
    { .name = "fill",
      .kind = WR_CLASS_EDIT,
      .args = wr_args_fill,
      .run = wr_run_fill,
      .help = "set every height",
      .example = "fill 0.5" },
    { .name = "grid",
      .kind = WR_CLASS_EDIT,
      .args = wr_args_grid,
      .run = wr_run_grid,
      .help = "replace the heights by a gridwork of lines",
      .details =
          "The lines lie on the boundaries of the cells. A texel is high where its centre, "
          "measured from the nearest boundary towards the right and downwards, lies at p with "
          "-width/2 <= p < width/2, along either axis; so the pattern is exact and periodic.",
      .example = "grid cells=4x4 width=6 high=0.5" },
    { .name = "image",
      .kind = WR_CLASS_EDIT,
      .args = wr_args_image,
      .run = wr_run_image,
      .help = "take the heights from a picture",
      .details =
          "8-bit and 16-bit pictures read as 0..1, float ones as their values; of RGB the Rec. "
          "709 luma of the codes is taken. A file that export wrote comes back as what it was: "
          "codes "
          "as the heights that its label tells, a normal map as the heights that have its normals. "
          "The table keeps its wrap. In a script the file is looked up beside the script.",
      .example = "image bricks.png fit=table" },
    { .name = "dab",
      .kind = WR_CLASS_EDIT,
      .args = wr_args_dab,
      .more = wr_args_brush,
      .run = wr_run_dab,
      .help = "touch the table once with a brush",
      .details = "With tip= it is a stamp. What is given takes the place of the preset's own.",
      .example = "dab 0.5,0.5 radius=40 strength=0.3" },
    { .name = "stroke",
      .kind = WR_CLASS_EDIT,
      .args = wr_args_stroke,
      .more = wr_args_brush,
      .run = wr_run_stroke,
      .help = "draw a brush along a path",
      .details =
          "The modes up to erode make a texel anew from the height that it had when the stroke "
          "began and the largest coverage it ever had, so crossing one's own stroke does not "
          "double "
          "it; flow= below 1, presets and buildup=on add the dabs up instead. smooth, level, pinch "
          "and smear change what they find, dab by dab. Samples are joined along the shorter way "
          "round. What is given takes the place of the preset's own. Symmetry draws the whole "
          "stroke again: mirrors, turns, and a lattice over the cell.",
      .example = "stroke points=0.1,0.5;0.9,0.5,0.4 radius=12 mode=lower" },
    { .name = "shape",
      .kind = WR_CLASS_EDIT,
      .form_word = "KIND",
      .form = wr_form_shape,
      .more = wr_args_brush,
      .run = wr_run_shape,
      .help = "draw or fill a rectangle, an ellipse, a polygon or a path",
      .details =
          "An outline is drawn as a stroke with the brush at full pressure; a closed one meets "
          "itself without doubling. A fill covers the inside, smooth at its edge, with what the "
          "mode does to texels that a stroke covers wholly; the brush's radius does not matter, "
          "and "
          "modes that move heights cannot fill. Shapes wrap round periodic edges and keep their "
          "form "
          "in a cell that is not square.",
      .example = "shape ellipse middle=0.5,0.5 radii=0.3,0.2 paint=fill strength=0.5" },
    { .name = "flood",
      .kind = WR_CLASS_EDIT,
      .args = wr_args_flood,
      .run = wr_run_flood,
      .help = "fill a connected part of about one height",
      .details = "The part is found in the composite, goes on across periodic edges, and has no "
                 "soft edge; "
                 "`select flood` selects it instead, to be feathered or grown.",
      .example = "flood 0.5,0.5 tolerance=0.05 mode=to to=1 strength=10" },
    { .name = "ramp",
      .kind = WR_CLASS_EDIT,
      .form_word = "KIND",
      .form = wr_form_ramp,
      .run = wr_run_ramp,
      .help = "heights that lead from one place to another",
      .example = "ramp linear from=0.1,0.5 to=0.6,0.5 fold=on" },
    { .name = "pattern",
      .kind = WR_CLASS_EDIT,
      .form_word = "KIND",
      .form = wr_form_pattern,
      .run = wr_run_generate,
      .help = "bricks, tiles, cloth, cells and other regular things",
      .details =
          "They close at the table's edges, and origin= rolls them. What they make joins the "
          "active "
          "layer inside the selection, as blend= says: replace, unless the row has another way.",
      .example = "pattern bricks across=4 rows=10 joint=5" },
    { .name = "noise",
      .kind = WR_CLASS_EDIT,
      .form_word = "KIND",
      .form = wr_form_noise,
      .run = wr_run_generate,
      .help = "sums of value, gradient or simplex noise",
      .details =
          "Heights become level + amplitude N, N the sum of octaves of ratio^-i noise, octave i "
          "with "
          "cells step^i cells, rounded, so that every octave closes at the table's edges. Octaves "
          "that would alias are left out. `wrinkle inspect --noise` tells N at any point.",
      .example = "noise perlin cells=6 octaves=5 amplitude=0.3" },
    { .name = "formula",
      .kind = WR_CLASS_EDIT,
      .form_word = "KIND",
      .form = wr_form_formula,
      .run = wr_run_generate,
      .help = "a polynomial or a Fourier series, texel by texel",
      .details = "It is what `analytic` shows, as heights that can be painted on.",
      .example = "formula fourier terms=3,0,0.5;0,5,0.25,90,0" },
    { .name = "text",
      .kind = WR_CLASS_EDIT,
      .row = wr_row_text,
      .run = wr_run_generate,
      .help = "letters of any font and script, in relief",
      .details = "They are added to the active layer, where they cover it, unless blend= says "
                 "otherwise. In quotes \\\\n begins a new line. Overlapping letters are one shape.",
      .example = "text Wrinkle font=serif size=90 profile=round bevel=6" },
    { .name = "solid",
      .kind = WR_CLASS_EDIT,
      .form_word = "KIND",
      .form = wr_form_solid,
      .run = wr_run_generate,
      .help = "solids, letters and meshes seen from above by a Z-buffer",
      .details =
          "They stand in the ground, which hides what is below height 0, and join the active "
          "layer by max unless blend= says otherwise. across= and rows= make lattices of "
          "them, crossing the table's edges exactly.",
      .example = "solid sphere across=8 rows=8 radius=16" },
    { .name = "terrain",
      .kind = WR_CLASS_EDIT,
      .form_word = "KIND",
      .form = wr_form_terrain,
      .run = wr_run_generate,
      .help = "mountains, real elevations, and what weather makes of them",
      .details = "fractal and elevation make ground; hydraulic, thermal and terraces change what "
                 "lies in the active layer. Weather only moves ground: the mean height stays.",
      .example = "terrain hydraulic rain=2" },
    { .name = "picture",
      .kind = WR_CLASS_EDIT,
      .form_word = "KIND",
      .form = wr_form_picture,
      .run = wr_run_generate,
      .help = "heights from pictures and from normal maps",
      .details = "photo takes the light of a picture, made seamless; normals finds the heights "
                 "that a normal map belongs to, and whether its green points up or down.",
      .example = "picture normals rock_normal.png height=0.1" },
    { .name = "open",
      .kind = WR_CLASS_EDIT,
      .args = wr_args_open,
      .run = wr_run_open,
      .help = "take a document's layers, selection and scene",
      .details = "In a script the file is looked up beside the script.",
      .example = "open bricks.exr" },
    { .name = "layer",
      .kind = WR_CLASS_EDIT,
      .form_word = "ACTION",
      .form = wr_form_layer,
      .run = wr_run_layer,
      .help = "add, order, join and set layers",
      .details =
          "Layers are named by their numbers, from 1 at the bottom, or by their names where only "
          "one "
          "has it. Edits go to the active layer; where it is locked or not shown they are refused.",
      .example = "layer add moss blend=max" },
    { .name = "select",
      .kind = WR_CLASS_EDIT,
      .form_word = "WHAT",
      .form = wr_form_select,
      .run = wr_run_select,
      .help = "choose where edits act",
      .details = "Shapes wrap round periodic edges, and their edges are smooth. An edit under a "
                 "selection s leaves old + s (new - old), and where s is 0 every bit as it was.",
      .example = "select ellipse centre=0.5,0.5 radii=0.3,0.2" },
    { .name = "adjust",
      .kind = WR_CLASS_EDIT,
      .form_word = "OPERATION",
      .form = wr_form_adjust,
      .run = wr_run_adjust,
      .help = "change a whole table: blur, levels, resize and the like",
      .details =
          "They act on the active layer inside the selection; those that change the table's size "
          "act "
          "on all layers, masks and the selection, locked or not. Where texels move, a layer's "
          "coverage and mask move along.",
      .example = "adjust blur sigma=3" },
    { .name = "surface",
      .kind = WR_CLASS_SCENE,
      .form_word = "NAME",
      .form = wr_form_surface,
      .run = wr_run_surface,
      .print = wr_print_surface,
      .help = "the surface that the table wrinkles",
      .details = "Parameters that are left out take their defaults.",
      .example = "surface torus R=1 r=0.35" },
    { .name = "rotate",
      .kind = WR_CLASS_VIEW,
      .args = wr_args_rotate,
      .run = wr_run_rotate,
      .print = wr_print_rotate,
      .help = "the object's orientation",
      .details =
          "It replaces the pose in which the surface first shows itself, and turns about the "
          "object's centre, which stands at the world's origin. A view is no edit: undo leaves it "
          "as it is, `view back` goes back.",
      .example = "rotate -90,0,30" },
    { .name = "analytic",
      .kind = WR_CLASS_SCENE,
      .form_word = "KIND",
      .form = wr_form_analytic,
      .run = wr_run_analytic,
      .print = wr_print_analytic,
      .help = "a formula in place of the table",
      .details = "It is evaluated at (ru u, rv v) reduced to [0,1), like a table, with exact "
                 "derivatives.",
      .example = "analytic fourier terms=3,0,0.5;0,5,0.25,90,0" },
    { .name = "bump",
      .kind = WR_CLASS_SCENE,
      .args = wr_args_bump,
      .run = wr_run_bump,
      .print = wr_print_bump,
      .help = "how the table turns the normal",
      .details = "Only what is given changes.",
      .example = "bump mode=exact height=0.05" },
    { .name = "replicate",
      .kind = WR_CLASS_SCENE,
      .args = wr_args_replicate,
      .run = wr_run_replicate,
      .print = wr_print_replicate,
      .help = "how often the table repeats over the surface",
      .example = "replicate 6,3" },
    { .name = "material",
      .kind = WR_CLASS_SCENE,
      .args = wr_args_material,
      .run = wr_run_material,
      .print = wr_print_material,
      .help = "what the surface reflects",
      .details = "Only what is given changes.",
      .example = "material diffuse=0.8 specular=0.3 shininess=60" },
    { .name = "colour",
      .kind = WR_CLASS_SCENE,
      .args = wr_args_colour,
      .run = wr_run_colour,
      .print = wr_print_colour,
      .help = "a colour picture on the surface",
      .details =
          "8-bit and 16-bit pictures are decoded from sRGB, float ones taken as linear; alpha is "
          "left out. The picture is saved inside the document.",
      .example = "colour peel.png" },
    { .name = "light",
      .kind = WR_CLASS_SCENE,
      .form_word = "KIND",
      .form = wr_form_light,
      .run = wr_run_light,
      .print = wr_print_light,
      .help = "add, replace or remove lights",
      .details = "The first light takes the place of the one that a new document has.",
      .example = "light directional to=-1,1,2 strength=0.9" },
    { .name = "camera",
      .kind = WR_CLASS_VIEW,
      .form_word = "KIND",
      .form = wr_form_camera,
      .run = wr_run_camera,
      .print = wr_print_camera,
      .help = "where the picture is taken from",
      .details = "Only what is given changes. A view is no edit: undo leaves it as it is, `view "
                 "back` goes back.",
      .example = "camera perspective eye=0,1,4 fov=30" },
    { .name = "dials",
      .kind = WR_CLASS_SCENE,
      .row = wr_row_dials,
      .run = wr_run_dials,
      .print = wr_print_dials,
      .help = "accuracy against time",
      .details = "Only what is given changes.",
      .example = "dials aa=supersample samples=4" },
    { .name = "tolerance",
      .kind = WR_CLASS_SCENE,
      .args = wr_args_tolerance,
      .run = wr_run_tolerance,
      .print = wr_print_tolerance,
      .help = "the cheapest dials that keep to an error",
      .details = "One of the four. Each picture measures a sample of itself and takes, for each "
                 "kind of block that it has, the cheapest slopes, normals and samples that meet "
                 "the tolerance; `wrinkle explain` says what it took, and whether that holds. save "
                 "keeps what the last picture took in chosen=.",
      .example = "tolerance rms=0.004" },
    { .name = "save",
      .kind = WR_CLASS_OUTPUT,
      .args = wr_args_save,
      .run = wr_run_save,
      .help = "save the document",
      .example = "save bricks.exr" },
    { .name = "export",
      .kind = WR_CLASS_OUTPUT,
      .form_word = "KIND",
      .form = wr_form_export,
      .args = wr_args_export,
      .run = wr_run_export,
      .help = "write the table for other programs",
      .example = "export height bricks.png" },
    { .name = "render",
      .kind = WR_CLASS_OUTPUT,
      .args = wr_args_render,
      .run = wr_run_render,
      .help = "write a picture of the scene",
      .example = "render bricks.png size=640x480" },
    { .name = "script",
      .kind = WR_CLASS_OUTPUT,
      .args = wr_args_script,
      .run = wr_run_script,
      .help = "write what was done as a script",
      .details = "The script makes the same document, bit for bit; undone steps are not in it, "
                 "and of the views only those that it takes.",
      .example = "script bricks.wrinkle" },
    { .name = "undo",
      .kind = WR_CLASS_HISTORY,
      .args = wr_args_undo,
      .run = wr_run_undo,
      .help = "go back to before the last commands",
      .details = "Every edit and every scene command is one step. How it is looked at stays, but "
                 "for a step that opened a document.",
      .example = "undo 2" },
    { .name = "redo",
      .kind = WR_CLASS_HISTORY,
      .args = wr_args_redo,
      .run = wr_run_redo,
      .help = "do again what was undone",
      .example = "redo" },
    { .name = "view",
      .kind = WR_CLASS_HISTORY,
      .form_word = "WAY",
      .form = wr_form_view,
      .run = wr_run_view,
      .help = "go back and forth through how it was looked at",
      .details = "Every `camera` and every `rotate` that changes something is one view; the last "
                 "thousand are kept. The edits stay as they are.",
      .example = "view back 2" },
    { .name = "history",
      .kind = WR_CLASS_HISTORY,
      .args = wr_args_history,
      .run = wr_run_history,
      .help = "how much memory undo may take",
      .details = "The oldest states go first; the last step can always be undone.",
      .example = "history budget=2e9" },
    { .name = NULL }
};

const int wr_command_count = (int)(sizeof wr_commands / sizeof *wr_commands) - 1;

const WrCommand *wr_command_find(const char *name)
{
    for (int i = 0; i < wr_command_count; i++)
        if (strcmp(wr_commands[i].name, name) == 0) return &wr_commands[i];
    return NULL;
}

int wr_command_form(const WrCommand *command, const char *name, WrForm *out)
{
    for (int i = 0; command->form && command->form(i, out); i++)
        if (strcmp(out->name, name) == 0) return i;
    return -1;
}

int wr_command_specs(const WrCommand *command, int form, WrArgSpec out[WR_ARGS_MAX])
{
    int count = 0;
    WrForm row;
    if (form >= 0 && command->form ? command->form(form, &row) : command->row && command->row(&row))
        while (count < WR_ARGS_MAX && row.args[count].name) {
            out[count] = row.args[count];
            count++;
        }
    for (const WrArgSpec *s = command->args; s && s->name && count < WR_ARGS_MAX; s++)
        out[count++] = *s;
    for (const WrArgSpec *s = command->more; s && s->name && count < WR_ARGS_MAX; s++)
        out[count++] = *s;
    return count;
}
