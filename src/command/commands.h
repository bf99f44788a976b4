/* commands.h - declarations of all command rows. Each row is at the end of the .c file that has its arguments,
   handler and printer. Private to src/command. */
#pragma once
#include "command/command_line.h"
#include "command/command_table.h"

#include <stdbool.h>

extern const WrCommand wr_command_table, wr_command_fill, wr_command_grid, wr_command_image,
    wr_command_dab, wr_command_stroke, wr_command_sculpt, wr_command_project, wr_command_shape,
    wr_command_flood, wr_command_ramp, wr_command_pattern, wr_command_noise, wr_command_formula,
    wr_command_text, wr_command_rim, wr_command_solid, wr_command_terrain, wr_command_picture,
    wr_command_open, wr_command_layer, wr_command_link, wr_command_variant, wr_command_select,
    wr_command_adjust, wr_command_filter, wr_command_object, wr_command_surface, wr_command_model,
    wr_command_ground, wr_command_rotate, wr_command_analytic, wr_command_bump,
    wr_command_replicate, wr_command_material, wr_command_grain, wr_command_colour,
    wr_command_colouring, wr_command_normalmap, wr_command_roughness, wr_command_metalness,
    wr_command_gltf, wr_command_bake, wr_command_bake_tiles, wr_command_light,
    wr_command_environment, wr_command_camera, wr_command_background, wr_command_tone,
    wr_command_cell, wr_command_sheet, wr_command_dials, wr_command_tolerance, wr_command_transform,
    wr_command_copy, wr_command_save, wr_command_export, wr_command_maps, wr_command_render,
    wr_command_script, wr_command_undo, wr_command_redo, wr_command_step, wr_command_macro,
    wr_command_view, wr_command_history;

/* ---- lists of steps: "3", "2,4..6" ---- */

typedef struct WrError WrError;
bool wr_check_steps(const void *ctx, const char *name, const char *value, WrError *err);
/* True if step `step`, from 1, is in a checked list. */
bool wr_step_listed(const char *list, int step);

/* ---- generators ---- */

/* The generator call in a command line such as `pattern bricks across=6`. */

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrGenerateJob WrGenerateJob;
typedef struct WrGenerator WrGenerator;
typedef struct WrLayer WrLayer;
typedef struct WrParamValue WrParamValue;
typedef struct WrPool WrPool;
typedef struct WrProgress WrProgress;
typedef struct WrRelief WrRelief;

/* The generator that the line names, or NULL if its verb is not a generator family. */
const WrGenerator *wr_call_generator(const WrCall *call);

/* Parameter values of the line, given or default. values: [WR_GENERATOR_PARAMS], borrowed from the call; texts and
 * file names are unresolved. */
void wr_call_values(const WrCall *call, const WrGenerator *generator, WrParamValue *values);

/* Name of an argument common to all generators ("blend", "radius", "offset"). If the generator has a parameter of the
 * same name, a prefix makes it unique: "blend-radius". */
const char *wr_generator_argument(const WrGenerator *generator, const char *plain);

/* Decode the escapes of a text argument: \n is a new line, \\ a backslash; a backslash before any other character is
 * literal. The caller frees the result. */
char *wr_generator_text(const char *text);

/* Blend the output of the line's generator into a layer, by the line's other arguments, within `selection` (NULL:
 * everywhere). False: cancelled, and the layer is half done. */
bool wr_call_join(const WrCall *call, const WrRelief *relief, const WrField *selection,
                  WrLayer *layer, WrPool *pool, const WrProgress *progress, WrError *err);

/* Make the output of the line's generator the content of a generator layer, by the line's offset and the layer's blend
 * mode. False: cancelled, and the layer is unchanged. */
bool wr_call_lay(const WrCall *call, const WrRelief *relief, WrLayer *layer, WrPool *pool,
                 const WrProgress *progress, WrError *err);

/* Give a new generator layer its line's blend mode and radius, and the selection (0..1; NULL: none) as its mask unless the
 * family works beyond it. */
void wr_call_begin_layer(const WrCall *call, const WrField *selection, WrLayer *layer);

/* Layers that a generator's line can name: those below `index` (WrGenerateJob.layer, layer_ctx). */
typedef struct WrDocument WrDocument;
typedef struct WrLayersBelow {
    const WrDocument *document;
    int index;
} WrLayersBelow;
bool wr_layers_below_find(void *ctx, const char *name, const WrField **heights,
                          const WrField **cover, WrError *err);
/* The argument of a generator's line that names such a layer; NULL: none is named. */
WrArg *wr_call_layer_argument(const WrCall *call);

/* Run the line's generator. Reads its files, and sets or checks their checksums in the call. job: with like, selection,
 * mask and progress; the rest is set. The caller owns *out. */
bool wr_call_make(WrSession *session, WrCall *call, WrGenerateJob *job, WrRelief *out,
                  WrError *err);

/* ---- live masks: live_masks.c ---- */

/* Check of a text argument: the terms of a live mask, or "off". */
bool wr_check_mask_line(const void *ctx, const char *name, const char *value, WrError *err);
void wr_mask_kind_explain(int i, WrText *text);

/* ---- transforms ---- */

/* Application of a `transform` line to a document, for the command and for previews of it. */

typedef struct WrDocument WrDocument;

/* True: the line moves the active layer or its mask; false: the layers of its of=, or all. */
bool wr_call_transforms_one(const WrCall *call);
/* active: the layer to change, or the stand-in for its mask; NULL unless the line moves one. False: cancelled or refused,
   and the document is half done. */
bool wr_call_transform(const WrCall *call, WrDocument *document, WrLayer *active, WrPool *pool,
                       const WrProgress *progress, WrError *err);
