/* The table itself. Choices, surfaces and export kinds come from the tables of their rooms. */
#include "command/inner.h"

#include "export/export.h"

#include <string.h>

const char *const wr_class_names[] = { "edit", "scene", "output" };

#define NUMBERS(...)                                                                               \
    (const double[])                                                                               \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
#define PLACE(x) .name = (x), .positional = true, .required = true

/* ---- words of choices ---- */

static const char *wrap_name(int i)
{
    static const char *const names[] = { "periodic", "clamp-u", "clamp-v", "clamp" };
    return i < 4 ? names[i] : NULL;
}

static const char *fit_name(int i)
{
    return i == 0 ? "table" : NULL;
}

static const char *off_on(int i)
{
    return i == 0 ? "off" : i == 1 ? "on" : NULL;
}

static const char *brush_mode_name(int i)
{
    return i < WR_BRUSH_MODE_COUNT ? wr_brush_modes[i].name : NULL;
}

static const char *bump_name(int i)
{
    return i < WR_BUMP_COUNT ? wr_bump_names[i] : NULL;
}

static const char *scheme_name(int i)
{
    return i < WR_SCHEME_COUNT ? wr_schemes[i].name : NULL;
}

static const char *antialias_name(int i)
{
    return i == WR_AA_POINT ? "point" : i == WR_AA_SUPERSAMPLE ? "supersample" : NULL;
}

static const char *arithmetic_name(int i)
{
    return i == WR_ARITHMETIC_EXACT ? "exact" : i == WR_ARITHMETIC_FAST ? "fast" : NULL;
}

/* ---- edits ---- */

static const WrArgSpec table_args[] = {
    { PLACE("WxH"), .type = WR_ARG_SIZE, .low = 1, .high = WR_FIELD_MAX, .unit = "texels",
      .help = "columns and rows" },
    { .name = "wrap",
      .type = WR_ARG_CHOICE,
      .choice = wrap_name,
      .fallback_text = "periodic",
      .help = "what lies beyond the edges: the table again, or its edge for u, for v, for both" },
    { 0 }
};

static const WrArgSpec fill_args[] = { { PLACE("F"), .type = WR_ARG_NUMBER, .low = -WR_BIG_HEIGHT,
                                         .high = WR_BIG_HEIGHT, .help = "the height" },
                                       { 0 } };

static const WrArgSpec grid_args[] = { { .name = "cells",
                                         .type = WR_ARG_SIZE,
                                         .shape = "MxN",
                                         .low = 1,
                                         .high = WR_FIELD_MAX,
                                         .fallback = NUMBERS(8, 8),
                                         .help = "cells across and down" },
                                       { .name = "width",
                                         .type = WR_ARG_NUMBER,
                                         .low = 0,
                                         .high = WR_FIELD_MAX,
                                         .fallback = NUMBERS(8),
                                         .unit = "texels",
                                         .help = "of the lines" },
                                       { .name = "low",
                                         .type = WR_ARG_NUMBER,
                                         .low = -WR_BIG_HEIGHT,
                                         .high = WR_BIG_HEIGHT,
                                         .fallback = NUMBERS(0),
                                         .help = "height of the cells" },
                                       { .name = "high",
                                         .type = WR_ARG_NUMBER,
                                         .low = -WR_BIG_HEIGHT,
                                         .high = WR_BIG_HEIGHT,
                                         .fallback = NUMBERS(1),
                                         .help = "height of the lines" },
                                       { 0 } };

static const WrArgSpec image_args[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "any picture" },
    { .name = "fit",
      .type = WR_ARG_CHOICE,
      .choice = fit_name,
      .help =
          "resample the picture to the table's size; without it the table takes the picture's" },
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "of the file: another content is then an error" },
    { 0 }
};

#define BRUSH_ARGS                                                                                 \
    { .name = "radius",                                                                            \
      .type = WR_ARG_NUMBER,                                                                       \
      .low = 0,                                                                                    \
      .high = 1e9,                                                                                 \
      .fallback = NUMBERS(16),                                                                     \
      .unit = "texels",                                                                            \
      .help = "from the centre to where nothing changes" },                                        \
        { .name = "hardness",                                                                      \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = 1,                                                                               \
          .fallback = NUMBERS(0.5),                                                                \
          .help = "part of the radius that is fully covered" },                                    \
        { .name = "strength",                                                                      \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .fallback = NUMBERS(0.1),                                                                \
          .help = "how much the centre changes" },                                                 \
        { .name = "mode",                                                                          \
          .type = WR_ARG_CHOICE,                                                                   \
          .choice = brush_mode_name,                                                               \
          .fallback_text = "raise",                                                                \
          .help = "raise or lower by the strength, or move to a height by at most the strength" }, \
        { .name = "to",                                                                            \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .fallback = NUMBERS(0),                                                                  \
          .help = "the height that mode=to moves to" },                                            \
    {                                                                                              \
        0                                                                                          \
    }

static const WrArgSpec dab_args[] = { { PLACE("u,v"), .type = WR_ARG_TUPLE, .components = 2,
                                        .low = -1e9, .high = 1e9, .help = "the centre; v up" },
                                      BRUSH_ARGS };

static const WrComponent sample_parts[] = {
    { "u", -1e9, 1e9, false },        { "v", -1e9, 1e9, false },
    { "pressure", -1e9, 1e9, false }, { "tilt_x", -1e9, 1e9, false },
    { "tilt_y", -1e9, 1e9, false },   { "seconds", -1e9, 1e9, false },
};
#define TUPLE_OF(n) (1u << (n))

static const WrArgSpec stroke_args[] = {
    { .name = "points",
      .type = WR_ARG_LIST,
      .required = true,
      .components = 6,
      .parts = sample_parts,
      .counts = TUPLE_OF(2) | TUPLE_OF(3) | TUPLE_OF(5) | TUPLE_OF(6),
      .rows_low = 1,
      .rows_high = WR_POINTS_MAX,
      .shape = "u,v[,pressure[,tilt_x,tilt_y[,seconds]]];...",
      .help = "the pen's samples in order; pressure is clamped to 0..1, tilt to -1..1" },
    BRUSH_ARGS
};

/* ---- the scene ---- */

static const WrComponent poly_parts[] = { { "i", 0, 64, true },
                                          { "j", 0, 64, true },
                                          { "a", -1e30, 1e30, false } };
static const WrComponent fourier_parts[] = {
    { "k", -16384, 16384, true },    { "l", -16384, 16384, true },    { "a", -1e30, 1e30, false },
    { "phase_u", -1e9, 1e9, false }, { "phase_v", -1e9, 1e9, false },
};

static const WrForm analytic_forms[] = {
    { .name = "poly",
      .help = "sum of a u^i v^j",
      .args = { { .name = "c",
                  .type = WR_ARG_LIST,
                  .required = true,
                  .components = 3,
                  .parts = poly_parts,
                  .rows_low = 1,
                  .rows_high = WR_TERMS_MAX,
                  .shape = "i,j,a;...",
                  .help = "the terms" } } },
    { .name = "fourier",
      .help = "sum of a cos(2 pi k u + phase_u) cos(2 pi l v + phase_v), phases in degrees",
      .args = { { .name = "terms",
                  .type = WR_ARG_LIST,
                  .required = true,
                  .components = 5,
                  .parts = fourier_parts,
                  .counts = TUPLE_OF(3) | TUPLE_OF(5),
                  .rows_low = 1,
                  .rows_high = WR_TERMS_MAX,
                  .shape = "k,l,a[,phase_u,phase_v];...",
                  .help = "the terms" } } },
    { .name = "off", .help = "the table again" },
};

static bool analytic_form(int i, WrForm *out)
{
    if (i >= (int)(sizeof analytic_forms / sizeof *analytic_forms)) return false;
    *out = analytic_forms[i];
    return true;
}

/* A surface's parameters as arguments; numbers of 3n components are lists of n points. */
static bool surface_form(int i, WrForm *out)
{
    if (i >= WR_SURFACE_COUNT) return false;
    const WrSurfaceInfo *info = wr_surfaces[i];
    *out = (WrForm){ .name = info->name, .help = info->help };
    for (int k = 0; k < WR_SURFACE_PARAMS && info->params[k].name; k++) {
        const WrSurfaceParam *p = &info->params[k];
        WrArgSpec spec = { .name = p->name,
                           .low = p->low,
                           .high = p->high,
                           .help = p->help,
                           .fallback = p->fallback };
        spec.type = p->components == 1   ? WR_ARG_NUMBER
                    : p->components <= 3 ? WR_ARG_TUPLE
                                         : WR_ARG_LIST;
        spec.components = p->components <= 3 ? p->components : 3;
        if (spec.type == WR_ARG_LIST) {
            spec.rows_low = spec.rows_high = spec.fallback_rows = p->components / 3;
            spec.shape = "x,y,z;...";
        }
        out->args[k] = spec;
    }
    return true;
}

static const WrArgSpec bump_args[] = {
    { .name = "mode",
      .type = WR_ARG_CHOICE,
      .choice = bump_name,
      .help =
          "how the normal is made: unchanged, the paper's N + D, the same whatever the scale, or "
          "the true normal of the displaced surface" },
    { .name = "scheme",
      .type = WR_ARG_CHOICE,
      .choice = scheme_name,
      .help = "how F is differentiated" },
    { .name = "height",
      .type = WR_ARG_NUMBER,
      .low = -1e30,
      .high = 1e30,
      .unit = "scene units",
      .help = "displacement where the table is 1" },
    { 0 }
};

static const WrArgSpec replicate_args[] = { { PLACE("ru,rv"), .type = WR_ARG_TUPLE, .components = 2,
                                              .low = -1e9, .high = 1e9,
                                              .help = "how often the table repeats along u and v" },
                                            { 0 } };

static const WrArgSpec rotate_args[] = {
    { PLACE("x,y,z"), .type = WR_ARG_TUPLE, .components = 3, .low = -1e9, .high = 1e9,
      .unit = "degrees", .help = "turns about the world's x, then y, then z axis" },
    { 0 }
};

static const WrArgSpec material_args[] = {
    { .name = "ambient", .type = WR_ARG_NUMBER, .low = 0, .high = 1000, .help = "ka" },
    { .name = "diffuse", .type = WR_ARG_NUMBER, .low = 0, .high = 1000, .help = "kd" },
    { .name = "specular", .type = WR_ARG_NUMBER, .low = 0, .high = 1000, .help = "ks" },
    { .name = "shininess",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 1e6,
      .help = "s, the highlight's exponent" },
    { .name = "colour",
      .type = WR_ARG_TUPLE,
      .components = 3,
      .low = 0,
      .high = 1e6,
      .shape = "r,g,b",
      .help = "C, linear; does not tint the highlight" },
    { .name = "gate",
      .type = WR_ARG_CHOICE,
      .choice = off_on,
      .help = "highlight only where the light is above the surface" },
    { 0 }
};

static const WrArgSpec colour_args[] = {
    { PLACE("FILE|off"), .type = WR_ARG_PATH,
      .help = "a picture that is laid over u and v once, or off (a file of that name is ./off)" },
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "of the file: another content is then an error" },
    { 0 }
};

#define LIGHT_ARGS                                                                                 \
    { .name = "colour",                                                                            \
      .type = WR_ARG_TUPLE,                                                                        \
      .components = 3,                                                                             \
      .low = 0,                                                                                    \
      .high = 1e6,                                                                                 \
      .shape = "r,g,b",                                                                            \
      .fallback = NUMBERS(1, 1, 1),                                                                \
      .help = "linear" },                                                                          \
        { .name = "strength",                                                                      \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = 1e6,                                                                             \
          .fallback = NUMBERS(1),                                                                  \
          .help = "times the colour" },                                                            \
    {                                                                                              \
        .name = "index", .type = WR_ARG_NUMBER, .low = 1, .high = WR_LIGHTS_MAX, .whole = true,    \
        .help = "replace this light, the first is 1; without it one is added"                      \
    }

static const WrForm light_forms[] = {
    { .name = "directional",
      .help = "light from far away",
      .args = { { .name = "to",
                  .type = WR_ARG_TUPLE,
                  .required = true,
                  .components = 3,
                  .low = -1e9,
                  .high = 1e9,
                  .help = "from the surface to the light, any length" },
                LIGHT_ARGS } },
    { .name = "point",
      .help = "light from a point",
      .args = { { .name = "at",
                  .type = WR_ARG_TUPLE,
                  .required = true,
                  .components = 3,
                  .low = -1e9,
                  .high = 1e9,
                  .unit = "scene units",
                  .help = "where it stands" },
                LIGHT_ARGS } },
    { .name = "clear", .help = "no light at all" },
};

static bool light_form(int i, WrForm *out)
{
    if (i >= (int)(sizeof light_forms / sizeof *light_forms)) return false;
    *out = light_forms[i];
    return true;
}

const char *wr_camera_kind_name(int i)
{
    return i == 0 ? "perspective" : i == 1 ? "orthographic" : NULL;
}

#define CAMERA_ARGS                                                                                \
    { .name = "eye",                                                                               \
      .type = WR_ARG_TUPLE,                                                                        \
      .components = 3,                                                                             \
      .low = -1e9,                                                                                 \
      .high = 1e9,                                                                                 \
      .unit = "scene units",                                                                       \
      .help = "where the camera stands" },                                                         \
        { .name = "target",                                                                        \
          .type = WR_ARG_TUPLE,                                                                    \
          .components = 3,                                                                         \
          .low = -1e9,                                                                             \
          .high = 1e9,                                                                             \
          .unit = "scene units",                                                                   \
          .help = "what it looks at" },                                                            \
        { .name = "up",                                                                            \
          .type = WR_ARG_TUPLE,                                                                    \
          .components = 3,                                                                         \
          .low = -1e9,                                                                             \
          .high = 1e9,                                                                             \
          .help = "what is up in the picture" },                                                   \
    {                                                                                              \
        .name = "fit", .type = WR_ARG_CHOICE, .choice = off_on,                                    \
        .help =                                                                                    \
            "on: stand so far from the target, towards the eye, that the object just fits; eye= "  \
            "turns it off"                                                                         \
    }

static const WrForm camera_forms[] = {
    { .name = "perspective",
      .help = "nearer is larger",
      .args = { CAMERA_ARGS,
                { .name = "fov",
                  .type = WR_ARG_NUMBER,
                  .low = 0.01,
                  .high = 179,
                  .unit = "degrees",
                  .help = "angle of view from bottom to top" } } },
    { .name = "orthographic",
      .help = "all distances alike",
      .args = { CAMERA_ARGS,
                { .name = "size",
                  .type = WR_ARG_NUMBER,
                  .low = 0,
                  .high = 1e9,
                  .unit = "scene units",
                  .help = "height of the view; 0: so that the object just fits" } } },
};

static bool camera_form(int i, WrForm *out)
{
    if (i >= (int)(sizeof camera_forms / sizeof *camera_forms)) return false;
    *out = camera_forms[i];
    return true;
}

static const WrArgSpec dials_args[] = {
    { .name = "aa",
      .type = WR_ARG_CHOICE,
      .choice = antialias_name,
      .help = "one sample at the pixel's centre, or samples x samples of them" },
    { .name = "samples",
      .type = WR_ARG_NUMBER,
      .low = 1,
      .high = 64,
      .whole = true,
      .help = "along each side of a pixel, for aa=supersample" },
    { .name = "arithmetic",
      .type = WR_ARG_CHOICE,
      .choice = arithmetic_name,
      .help = "the same bits on every processor, or faster" },
    { 0 }
};

/* ---- files ---- */

static const WrArgSpec save_args[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "an OpenEXR file, *.exr" }, { 0 }
};

static bool check_export_option(const void *ctx, const char *name, const char *value, WrError *err)
{
    WrExportOptions options = wr_export_default();
    return wr_export_option(ctx, &options, name, value, err);
}

static bool export_form(int i, WrForm *out)
{
    if (i >= WR_EXPORT_KIND_COUNT) return false;
    const WrExportKind *kind = &wr_export_kinds[i];
    *out = (WrForm){ .name = kind->name, .help = kind->help };
    for (int k = 0; k < WR_EXPORT_OPTIONS && kind->options[k].name; k++)
        out->args[k] = (WrArgSpec){ .name = kind->options[k].name,
                                    .type = WR_ARG_TEXT,
                                    .shape = kind->options[k].values,
                                    .help = kind->options[k].help,
                                    .check = check_export_option,
                                    .check_ctx = kind };
    return true;
}

static const WrArgSpec export_args[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "the format goes by its ending" }, { 0 }
};

static const WrArgSpec render_args[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH,
      .help = "exr and tiff hold linear float with coverage, others 8-bit sRGB" },
    { .name = "size",
      .type = WR_ARG_SIZE,
      .low = 1,
      .high = 16384,
      .fallback = NUMBERS(512, 512),
      .unit = "pixels",
      .help = "of the picture" },
    { 0 }
};

/* ---- the table ---- */

const WrCommand wr_commands[] = {
    { .name = "table",
      .kind = WR_CLASS_EDIT,
      .args = table_args,
      .run = wr_run_table,
      .help = "a new height table, everywhere 0",
      .example = "table 512x256 wrap=clamp-v" },
    { .name = "fill",
      .kind = WR_CLASS_EDIT,
      .args = fill_args,
      .run = wr_run_fill,
      .help = "set every height",
      .example = "fill 0.5" },
    { .name = "grid",
      .kind = WR_CLASS_EDIT,
      .args = grid_args,
      .run = wr_run_grid,
      .help = "replace the heights by a gridwork of lines",
      .details =
          "The lines lie on the boundaries of the cells. A texel is high where its centre, "
          "measured from the nearest boundary towards the right and downwards, lies at p with "
          "-width/2 <= p < width/2, along either axis; so the pattern is exact and periodic.",
      .example = "grid cells=4x4 width=6 high=0.5" },
    { .name = "image",
      .kind = WR_CLASS_EDIT,
      .args = image_args,
      .run = wr_run_image,
      .help = "take the heights from a picture",
      .details =
          "8-bit and 16-bit pictures read as 0..1, float ones as their values; of RGB the Rec. "
          "709 luma of the codes is taken. The table keeps its wrap. In a script the file is "
          "looked up beside the script.",
      .example = "image bricks.png fit=table" },
    { .name = "dab",
      .kind = WR_CLASS_EDIT,
      .args = dab_args,
      .run = wr_run_dab,
      .help = "touch the table once with the round brush",
      .example = "dab 0.5,0.5 radius=40 strength=0.3" },
    { .name = "stroke",
      .kind = WR_CLASS_EDIT,
      .args = stroke_args,
      .run = wr_run_stroke,
      .help = "draw the round brush along a path",
      .details =
          "Each texel is covered at most once by a stroke, by the largest coverage times the "
          "pen's pressure there (1 where it is left out).",
      .example = "stroke points=0.1,0.5;0.9,0.5,0.4 radius=12 mode=lower" },
    { .name = "surface",
      .kind = WR_CLASS_SCENE,
      .form_word = "NAME",
      .form = surface_form,
      .run = wr_run_surface,
      .print = wr_print_surface,
      .help = "the surface that the table wrinkles",
      .details = "Parameters that are left out take their defaults.",
      .example = "surface torus R=1 r=0.35" },
    { .name = "rotate",
      .kind = WR_CLASS_SCENE,
      .args = rotate_args,
      .run = wr_run_rotate,
      .print = wr_print_rotate,
      .help = "the object's orientation",
      .details =
          "It replaces the pose in which the surface first shows itself, and turns about the "
          "object's centre, which stands at the world's origin.",
      .example = "rotate -90,0,30" },
    { .name = "analytic",
      .kind = WR_CLASS_SCENE,
      .form_word = "KIND",
      .form = analytic_form,
      .run = wr_run_analytic,
      .print = wr_print_analytic,
      .help = "a formula in place of the table",
      .details = "It is evaluated at (ru u, rv v) reduced to [0,1), like a table, with exact "
                 "derivatives.",
      .example = "analytic fourier terms=3,0,0.5;0,5,0.25,90,0" },
    { .name = "bump",
      .kind = WR_CLASS_SCENE,
      .args = bump_args,
      .run = wr_run_bump,
      .print = wr_print_bump,
      .help = "how the table turns the normal",
      .details = "Only what is given changes.",
      .example = "bump mode=exact height=0.05" },
    { .name = "replicate",
      .kind = WR_CLASS_SCENE,
      .args = replicate_args,
      .run = wr_run_replicate,
      .print = wr_print_replicate,
      .help = "how often the table repeats over the surface",
      .example = "replicate 6,3" },
    { .name = "material",
      .kind = WR_CLASS_SCENE,
      .args = material_args,
      .run = wr_run_material,
      .print = wr_print_material,
      .help = "what the surface reflects",
      .details = "Only what is given changes.",
      .example = "material diffuse=0.8 specular=0.3 shininess=60" },
    { .name = "colour",
      .kind = WR_CLASS_SCENE,
      .args = colour_args,
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
      .form = light_form,
      .run = wr_run_light,
      .print = wr_print_light,
      .help = "add, replace or remove lights",
      .details = "The first light takes the place of the one that a new document has.",
      .example = "light directional to=-1,1,2 strength=0.9" },
    { .name = "camera",
      .kind = WR_CLASS_SCENE,
      .form_word = "KIND",
      .form = camera_form,
      .run = wr_run_camera,
      .print = wr_print_camera,
      .help = "where the picture is taken from",
      .details = "Only what is given changes.",
      .example = "camera perspective eye=0,1,4 fov=30" },
    { .name = "dials",
      .kind = WR_CLASS_SCENE,
      .args = dials_args,
      .run = wr_run_dials,
      .print = wr_print_dials,
      .help = "accuracy against time",
      .details = "Only what is given changes.",
      .example = "dials aa=supersample samples=4" },
    { .name = "save",
      .kind = WR_CLASS_OUTPUT,
      .args = save_args,
      .run = wr_run_save,
      .help = "save the document",
      .example = "save bricks.exr" },
    { .name = "export",
      .kind = WR_CLASS_OUTPUT,
      .form_word = "KIND",
      .form = export_form,
      .args = export_args,
      .run = wr_run_export,
      .help = "write the table for other programs",
      .example = "export height bricks.png" },
    { .name = "render",
      .kind = WR_CLASS_OUTPUT,
      .args = render_args,
      .run = wr_run_render,
      .help = "write a picture of the scene",
      .example = "render bricks.png size=640x480" },
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
    if (form >= 0 && command->form && command->form(form, &row))
        while (count < WR_ARGS_MAX && row.args[count].name) {
            out[count] = row.args[count];
            count++;
        }
    for (const WrArgSpec *s = command->args; s && s->name && count < WR_ARGS_MAX; s++)
        out[count++] = *s;
    return count;
}
