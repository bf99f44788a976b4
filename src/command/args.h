/* args.h - macros and shared choices for argument rows of the command table. Choices, surfaces and export kinds come
   from the tables of their modules. Private to src/command. */
#pragma once
#include "base/vec.h"
#include "command/command_line.h"
#include "command/session_internal.h"
#include "field/wrap.h"
#include "surface/surface.h"

#include <stdbool.h>

/* Default numbers. */
#define NUMBERS(...)                                                                               \
    (const double[])                                                                               \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
/* A required positional value. */
#define PLACE(x) .name = (x), .positional = true, .required = true
/* Half axes of an ellipse. */
#define WR_ARG_RADII                                                                               \
    {                                                                                              \
        .name = "radii", .type = WR_ARG_TUPLE, .required = true, .components = 2,                  \
        .shape = "ru,rv", .low = 0, .high = WR_SELECT_REACH,                                       \
        .help = "half its width and height, as fractions of the cell"                              \
    }
/* Centre of an ellipse. */
#define WR_ARG_MIDDLE                                                                              \
    .name = "at", .type = WR_ARG_TUPLE, .required = true, .components = 2, .shape = "u,v",         \
    .low = -WR_SELECT_REACH, .high = WR_SELECT_REACH, .help = "its centre"
/* The connected region of similar height around a point. */
#define WR_ARGS_FLOOD(of)                                                                          \
    { PLACE("u,v"), .also = "at", .type = WR_ARG_TUPLE,         .components = 2,                   \
      .low = -1e6,  .high = 1e6,  .help = "start of the region" },                                 \
        { .name = "tolerance",                                                                     \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_BIG_HEIGHT,                                                                   \
          .fallback = NUMBERS(0.01),                                                               \
          .unit = "height units",                                                                  \
          .help = "largest difference between " of " and the one at u,v" },                        \
    {                                                                                              \
        .name = "diagonal", .type = WR_ARG_CHOICE, .words = wr_off_on, .fallback_text = "off",     \
        .help = "on: texels that touch at a corner are connected too"                              \
    }
/* Channel and part of a picture file (WrImageRequest). */
#define WR_ARGS_OF_FILE                                                                            \
    { .name = "layer",                                                                             \
      .also = "channel",                                                                           \
      .type = WR_ARG_TEXT,                                                                         \
      .shape = "NAME",                                                                             \
      .help = "for an EXR file: a channel (Depth.Z) or a layer of channels (diffuse); left out, "  \
              "the first with colours or grey, else the first channel" },                          \
    {                                                                                              \
        .name = "part", .type = WR_ARG_TEXT, .shape = "N or NAME",                                 \
        .help = "for a file with several parts: number or name; or the frame of an animation; "    \
                "left out, the first"                                                              \
    }
/* WrCommand.form callback for a list of forms. */
#define WR_FORMS(function, list)                                                                   \
    static bool function(int i, WrForm *out)                                                       \
    {                                                                                              \
        if (i >= (int)(sizeof(list) / sizeof *(list))) return false;                               \
        *out = (list)[i];                                                                          \
        return true;                                                                               \
    }
/* Bit of WrArgSpec.counts: a tuple of a list may have n numbers. */
#define TUPLE_OF(n) (1u << (n))

extern const char *const wr_off_on[]; /* "off", "on" */

/* ---- argument rows shared by all painting commands ---- */

const char *wr_brush_mode_name(int i); /* word i of mode=, NULL past the last */
/* includes the names of the arguments that the mode uses */
void wr_brush_mode_explain(int i, WrText *text);
extern const WrArgSpec wr_args_brush[]; /* the last row has name NULL */

/* ---- transforms ---- */

/* turn= and scale= of commands that transform a layer's piece (generate/transform_piece.h). about: help of turn= */
#define WR_TRANSFORM_ARGS(about)                                                                   \
    { .name = "turn",                                                                              \
      .type = WR_ARG_NUMBER,                                                                       \
      .low = -36000,                                                                               \
      .high = 36000,                                                                               \
      .fallback = NUMBERS(0),                                                                      \
      .unit = "degrees",                                                                           \
      .help = (about) },                                                                           \
    {                                                                                              \
        .name = "scale", .type = WR_ARG_TUPLE, .components = 2, .shape = "su,sv",                  \
        .low = -WR_PLACE_SCALE, .high = WR_PLACE_SCALE, .fallback = NUMBERS(1, 1),                 \
        .help = "scale factors along u and v, applied before the turn; negative values mirror"     \
    }

/* ---- the brush ---- */

/* Arguments of commands that paint, with a brush or without. */
#define PAINT_ARGS                                                                                 \
    { .name = "strength",                                                                          \
      .type = WR_ARG_NUMBER,                                                                       \
      .low = -WR_BIG_HEIGHT,                                                                       \
      .high = WR_BIG_HEIGHT,                                                                       \
      .fallback = NUMBERS(0.1),                                                                    \
      .help = "change at the centre of the brush" },                                               \
        { .name = "mode",                                                                          \
          .type = WR_ARG_CHOICE,                                                                   \
          .choice = wr_brush_mode_name,                                                            \
          .explain = wr_brush_mode_explain,                                                        \
          .fallback_text = "raise",                                                                \
          .help = "brush mode" },                                                                  \
        { .name = "to",                                                                            \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .fallback = NUMBERS(0),                                                                  \
          .help = "target height of the modes that have one" },                                    \
        { .name = "opacity",                                                                       \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = 1,                                                                               \
          .fallback = NUMBERS(1),                                                                  \
          .help = "opacity of the whole stroke" },                                                 \
        { .name = "reach",                                                                         \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_FIELD_MAX,                                                                    \
          .fallback = NUMBERS(0),                                                                  \
          .unit = "texels",                                                                        \
          .help = "radius of the neighbourhood, for the modes that have one; 0: an eighth of the " \
                  "brush's radius, at least 1" },                                                  \
    {                                                                                              \
        .name = "source", .type = WR_ARG_TUPLE, .components = 2, .shape = "du,dv", .low = -1e6,    \
        .high = 1e6, .help = "clone: the heights are copied from u + du, v + dv"                   \
    }

/* A point of a shape or a ramp. */
#define POINT(name_, help_)                                                                        \
    {                                                                                              \
        .name = name_, .type = WR_ARG_TUPLE, .required = true, .components = 2, .shape = "u,v",    \
        .low = -WR_SELECT_REACH, .high = WR_SELECT_REACH, .help = help_                            \
    }

/* ---- numbers, colours and switches of a scene as command arguments, by the rows of scene/param.h ---- */

/* `form` is the command's form, NULL without forms. */

typedef struct WrSceneParam WrSceneParam;
typedef struct WrError WrError;
typedef struct WrScene WrScene;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

/* Write their arguments in the table's order; returns their number. */
int wr_scene_args(const char *command, const char *form, WrArgSpec *out);
/* Store the line's values in `owner` (the scene, or the light); parameters without a value get their default if their
   row is marked so. */
void wr_scene_take(const WrCall *call, const char *form, void *owner);
/* Print " name=value" for each parameter that is written with its name. */
void wr_scene_print_params(const char *command, const char *form, const void *owner, WrText *text);
/* Rotation of the object as "x,y,z" or as the word for the surface's default pose. */
#define WR_OWN_TURN "own"
bool wr_scene_take_turn(const char *text, WrScene *scene, WrError *err);
void wr_scene_print_vec(WrVec3 v, WrText *text); /* "x,y,z" */
/* Print " name=word"; nothing if word is NULL. */
void wr_print_word(const char *name, const char *word, WrText *text);
/* Print the value of one parameter as "x,y,z". */
void wr_scene_print_value(const WrSceneParam *param, const void *owner, WrText *text);
