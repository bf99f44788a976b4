/* args.h - the rows of arguments that the table of commands is made of, by subject: args_table.c,
   args_brush.c, args_layer.c, args_scene.c, args_output.c, args_history.c. Choices, surfaces and export
   kinds come from the tables of their rooms.
   Layer 6, private to src/command. */
#pragma once
#include "command/inner.h"

/* Numbers of a default. */
#define NUMBERS(...)                                                                               \
    (const double[])                                                                               \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
/* A required value without a name. */
#define PLACE(x) .name = (x), .positional = true, .required = true
/* What of a picture file is taken (WrImageWish). */
#define WR_ARGS_OF_FILE                                                                            \
    { .name = "channel",                                                                           \
      .type = WR_ARG_TEXT,                                                                         \
      .shape = "NAME",                                                                             \
      .help = "of an EXR file: a channel (Depth.Z) or a layer of them (diffuse); left out, its "   \
              "first colours or grey, else its first channel" },                                   \
    {                                                                                              \
        .name = "part", .type = WR_ARG_TEXT, .shape = "N or NAME",                                 \
        .help = "of a file with several, or a frame of an animation; left out, the first"          \
    }
/* A tuple of a list may have n numbers. */
#define TUPLE_OF(n) (1u << (n))

/* Each ends with name NULL. */
extern const WrArgSpec wr_args_table[], wr_args_fill[], wr_args_grid[], wr_args_image[],
    wr_args_open[];
extern const WrArgSpec wr_args_brush[], wr_args_dab[], wr_args_stroke[], wr_args_flood[];
extern const WrArgSpec wr_args_rotate[], wr_args_bump[], wr_args_replicate[], wr_args_material[],
    wr_args_colour[], wr_args_tolerance[];
extern const WrArgSpec wr_args_save[], wr_args_export[], wr_args_render[];
extern const WrArgSpec wr_args_undo[], wr_args_redo[], wr_args_history[], wr_args_script[];

/* The rows of forms, as in WrCommand. */
typedef bool WrFormRow(int index, WrForm *out);
WrFormRow wr_form_layer, wr_form_select, wr_form_adjust, wr_form_surface, wr_form_analytic,
    wr_form_light, wr_form_camera, wr_form_export, wr_form_shape, wr_form_ramp, wr_form_view;
/* Of the families of generators: args_generate.c. */
WrFormRow wr_form_pattern, wr_form_noise, wr_form_formula, wr_form_solid, wr_form_terrain,
    wr_form_picture;
bool wr_row_text(WrForm *out);
bool wr_row_dials(WrForm *out); /* of the table of dials: args_scene.c */
