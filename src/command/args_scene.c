/* Arguments of the scene commands. */
#include "command/args.h"

#include <string.h>

static const char *off_on(int i)
{
    return i == 0 ? "off" : i == 1 ? "on" : NULL;
}

static const char *bump_name(int i)
{
    return i < WR_BUMP_COUNT ? wr_bump_names[i] : NULL;
}

static const char *scheme_name(int i)
{
    return i < WR_SCHEME_COUNT ? wr_schemes[i].name : NULL;
}

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

bool wr_form_analytic(int i, WrForm *out)
{
    if (i >= (int)(sizeof analytic_forms / sizeof *analytic_forms)) return false;
    *out = analytic_forms[i];
    return true;
}

/* A surface's parameters as arguments; numbers of 3n components are lists of n points. */
bool wr_form_surface(int i, WrForm *out)
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

const WrArgSpec wr_args_bump[] = {
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

const WrArgSpec wr_args_replicate[] = { { PLACE("ru,rv"), .type = WR_ARG_TUPLE, .components = 2,
                                          .low = -1e9, .high = 1e9,
                                          .help = "how often the table repeats along u and v" },
                                        { 0 } };

static const char *pose_word(int i)
{
    return i == 0 ? "own" : NULL;
}

const WrArgSpec wr_args_rotate[] = {
    { .name = "x,y,z",
      .type = WR_ARG_TUPLE,
      .positional = true,
      .components = 3,
      .low = -1e9,
      .high = 1e9,
      .unit = "degrees",
      .help = "turns about the world's x, then y, then z axis" },
    { .name = "pose",
      .type = WR_ARG_CHOICE,
      .choice = pose_word,
      .help = "instead: the pose in which each surface first shows itself" },
    { 0 }
};

const WrArgSpec wr_args_material[] = {
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

const WrArgSpec wr_args_colour[] = {
    { PLACE("FILE|off"), .type = WR_ARG_PATH,
      .help = "a picture that is laid over u and v as often as replicate says, like the table, or "
              "off (a file of that name is ./off)" },
    WR_ARGS_OF_FILE,
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

bool wr_form_light(int i, WrForm *out)
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

bool wr_form_camera(int i, WrForm *out)
{
    if (i >= (int)(sizeof camera_forms / sizeof *camera_forms)) return false;
    *out = camera_forms[i];
    return true;
}

static const char *tolerance_off(int i)
{
    return i == 0 ? "off" : NULL;
}

const WrArgSpec wr_args_tolerance[] = {
    { .name = "off",
      .type = WR_ARG_CHOICE,
      .positional = true,
      .choice = tolerance_off,
      .help = "the dials hold as they are set" },
    { .name = "rms",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .above = true,
      .high = 1e6,
      .unit = "linear intensity",
      .help = "root mean square error over the object's pixels, at most" },
    { .name = "max",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .above = true,
      .high = 1e6,
      .unit = "linear intensity",
      .help = "error of any channel of any pixel, at most" },
    { .name = "time",
      .type = WR_ARG_TEXT,
      .shape = "8ms or 0.5s",
      .check = wr_check_duration,
      .help = "of a frame: the least error that it buys; 0.1ms to 3600s" },
    { .name = "chosen",
      .type = WR_ARG_TEXT,
      .shape = "dials as save writes them",
      .check = wr_check_chosen,
      .help =
          "what was chosen for the last picture, block by block: used again for the same table, "
          "scene, size and turn" },
    { 0 }
};

/* One argument a dial: the table's rows that this command sets. */
bool wr_row_dials(WrForm *out)
{
    int count = 0;
    *out = (WrForm){ 0 };
    for (int i = 0; i < WR_DIAL_COUNT; i++) {
        const WrDial *dial = &wr_dials[i];
        if (strcmp(dial->command, "dials") != 0) continue;
        out->args[count++] = (WrArgSpec){ .name = dial->name,
                                          .type = dial->choices > 0 ? WR_ARG_CHOICE : WR_ARG_NUMBER,
                                          .choice = dial->choice,
                                          .low = dial->low,
                                          .high = dial->high,
                                          .whole = dial->whole,
                                          .help = dial->help };
    }
    return true;
}
