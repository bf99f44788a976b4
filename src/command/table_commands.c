/* Commands for the whole table: table, fill, grid, open, image. */
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "document/document_file.h"
#include "field/field.h"
#include "generate/generator.h"
#include "image/svg.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

static bool run_table(WrSession *session, WrCall *call, WrError *err)
{
    const WrArg *size = wr_call_arg(call, "WxH");
    int wrap = wr_call_choice(call, "wrap"); /* bit 0: clamp u, bit 1: clamp v */
    WrField *field = wr_field_new((int)size->numbers[0], (int)size->numbers[1],
                                  wrap & 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC,
                                  wrap & 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC, 0, err);
    if (!field) return false;
    wr_document_start_over(session->state.document, field);
    return true;
}

/* A table of the layer's size and edges with constant height `level`. */
static WrField *flat_like(const WrField *field, double level)
{
    return wr_field_new(wr_field_width(field), wr_field_height(field), wr_field_wrap_u(field),
                        wr_field_wrap_v(field), (float)level, NULL);
}

static bool run_fill(WrSession *session, WrCall *call, WrError *err)
{
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer) return false;
    wr_session_put_heights(session, layer, flat_like(layer->heights, wr_call_number(call, "F")));
    return true;
}

/* ---- grid ---- */

/* Mark the texels on grid lines among `count` texels along an axis of `cells` cells. The texel's centre is at i + 1/2
 * and boundaries are at multiples of count/cells. The signed distance p to the nearest boundary is an exact fraction
 * q / (2 cells), q an integer, -count <= q < count. A texel is high where -width/2 <= p < width/2. */
static void mark_lines(int count, int cells, double width, unsigned char *high)
{
    double limit = width * cells; /* in units of q */
    for (int i = 0; i < count; i++) {
        int64_t q = (2 * (int64_t)i + 1) * cells % (2 * (int64_t)count);
        if (q >= count) q -= 2 * (int64_t)count;
        high[i] = -limit <= (double)q && (double)q < limit;
    }
}

static bool any_set(const unsigned char *marks, int count)
{
    return memchr(marks, 1, (size_t)count) != NULL;
}

static bool draw_lines(WrField *field, const unsigned char *columns, const unsigned char *rows,
                       float level)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    for (int ty = 0; ty < wr_field_tiles_v(field); ty++) {
        if (!wr_progress_report((double)ty / wr_field_tiles_v(field))) return false;
        for (int tx = 0; tx < wr_field_tiles_u(field); tx++) {
            int i = tx * WR_TILE, j = ty * WR_TILE;
            int w = width - i < WR_TILE ? width - i : WR_TILE;
            int h = height - j < WR_TILE ? height - j : WR_TILE;
            if (!any_set(columns + i, w) && !any_set(rows + j, h)) continue;
            float *texels = wr_field_tile_write(field, tx, ty);
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++)
                    if (columns[i + x] || rows[j + y]) texels[WR_TILE * y + x] = level;
        }
    }
    return true;
}

static bool run_grid(WrSession *session, WrCall *call, WrError *err)
{
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer) return false;
    WrField *field = flat_like(layer->heights, wr_call_number(call, "low"));
    const WrArg *cells = wr_call_arg(call, "cells");
    double width = wr_call_number(call, "width");
    unsigned char *columns = wr_alloc((size_t)wr_field_width(field), 1);
    unsigned char *rows = wr_alloc((size_t)wr_field_height(field), 1);
    mark_lines(wr_field_width(field), (int)cells->numbers[0], width, columns);
    mark_lines(wr_field_height(field), (int)cells->numbers[1], width, rows);
    bool good = draw_lines(field, columns, rows, (float)wr_call_number(call, "high"));
    wr_free(columns);
    wr_free(rows);
    if (good) wr_session_put_heights(session, layer, field);
    else wr_field_free(field);
    return good || wr_fail(err, "cancelled");
}

/* ---- open ---- */

#define DRAWING_SIDE 1024 /* texels of the longer side of a drawing's page */

/* An empty table with the proportions of the drawing's page, and the drawing as a generator layer. */
static bool open_drawing(WrSession *session, const char *path, WrError *err)
{
    const WrSvgRequest ask = { .side = DRAWING_SIDE, .page = 1 };
    const WrField *old = session->state.document->layers[0].heights;
    const int wrap =
        (wr_field_wrap_u(old) == WR_WRAP_CLAMP) | (wr_field_wrap_v(old) == WR_WRAP_CLAMP) << 1;
    WrSvg page = { 0 };
    WrText table = { 0 }, layer = { 0 }, from = { 0 };
    if (!wr_svg_read(path, &ask, &page, err)) return false;
    wr_text_addf(&table, "table %dx%d wrap=%s", page.box[0] < 1.0 ? 1 : (int)rint(page.box[0]),
                 page.box[1] < 1.0 ? 1 : (int)rint(page.box[1]), wr_document_wrap_name(wrap));
    wr_svg_fini(&page);
    wr_text_add(&from, "picture svg ");
    wr_text_add_word(&from, path);
    wr_text_addf(&from, " box=page size=%d", DRAWING_SIDE);
    wr_text_add(&layer, "layer add ");
    wr_text_add_file_name(&layer, path);
    wr_text_add(&layer, " from=");
    wr_text_add_word(&layer, wr_text_get(&from));
    const bool good = wr_session_run(session, wr_text_get(&table), err) &&
                      wr_session_run(session, wr_text_get(&layer), err);
    wr_text_fini(&table);
    wr_text_fini(&layer);
    wr_text_fini(&from);
    return good;
}

static bool run_open(WrSession *session, WrCall *call, WrError *err)
{
    char *path = wr_session_input_path(session, wr_call_arg(call, "FILE")->text);
    bool good = wr_session_check_sha256(call, path, err) &&
                (wr_svg_named(path) ? open_drawing(session, path, err)
                                    : wr_session_load(session, path, err));
    wr_free(path);
    return good;
}

/* True if there is only one layer, so that the table's size may change. */
static bool is_alone(const WrDocument *document)
{
    return document->layer_count == 1 && !document->selection && !document->layers[0].mask;
}

static bool replace_table(WrSession *session, WrLayer *layer, WrField *field, WrError *err)
{
    const WrDocument *document = session->state.document;
    if (!is_alone(document)) {
        wr_fail(err,
                "the picture is %dx%d, the table %dx%d: with more layers, a mask or a selection it "
                "must be resampled (fit=table)",
                wr_field_width(field), wr_field_height(field), wr_field_width(layer->heights),
                wr_field_height(layer->heights));
        wr_field_free(field);
        return false;
    }
    wr_field_free(layer->heights);
    wr_field_free(layer->cover);
    layer->heights = field;
    layer->cover = NULL;
    return true;
}

static void hear(void *ctx, const char *text)
{
    wr_session_note(ctx, "%s", text);
}

static WrParamValue *value_of(const WrGenerator *row, WrParamValue *values, const char *name)
{
    return &values[wr_generator_param_find(row, name)];
}

static void turn_over(WrField *field)
{
    const int width = wr_field_width(field);
    float *row = wr_alloc((size_t)width, sizeof *row);
    for (int j = 0; j < wr_field_height(field); j++) {
        wr_field_read(field, 0, j, width, 1, row, (size_t)width);
        for (int i = 0; i < width; i++) row[i] = 0.0f - row[i];
        wr_field_write(field, 0, j, width, 1, row, (size_t)width);
    }
    wr_free(row);
}

/* Heights from a normal map made by this program; a negative height had inverted it. */
static WrField *heights_of_map(WrSession *session, const WrImageLabel *label, const char *path,
                               const WrField *like, WrError *err)
{
    const WrGenerator *row = wr_generator_find("picture", "normals");
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrRelief relief = { NULL, NULL };
    wr_generator_defaults(row, values);
    value_of(row, values, "file")->text = path;
    value_of(row, values, "y")->number[0] = label->kind == WR_LABEL_NORMAL_DOWN ? 2 : 1;
    value_of(row, values, "cell")->number[0] = label->cell[0];
    value_of(row, values, "cell")->number[1] = label->cell[1];
    value_of(row, values, "height")->number[0] = fabs(label->height);
    WrGenerateJob job = {
        .like = like, .pool = session->options.pool, .note = hear, .note_ctx = session
    };
    if (!wr_generator_make(row, values, &job, &relief, err)) return NULL;
    wr_field_free(relief.cover);
    if (label->height < 0) turn_over(relief.heights);
    return relief.heights;
}

static void note_range(WrSession *session, const WrImage *image, const char *path)
{
    const WrImageLabel *label = &image->label;
    const double last = wr_pixel_type_max(image->type);
    wr_session_note(session,
                    "%s: by its metadata, codes 0 to %g are heights %g to %g, and are read as such "
                    "(labels=ignore reads 0 to 1)",
                    path, last, label->low - label->step * label->zero,
                    label->low + label->step * (last - label->zero));
}

WrField *wr_session_heights_of(WrSession *session, WrImageRows *rows, const char *path, bool labels,
                               const WrField *like, WrError *err)
{
    const WrImage *image = wr_image_rows_head(rows);
    const WrImageLabel *label = &image->label;
    if (labels && label->refused[0])
        wr_session_note(session, "%s: its metadata %s is invalid and not used", path,
                        label->refused);
    if (labels && label->kind >= WR_LABEL_NORMAL_UP) {
        wr_session_note(session,
                        "%s: by its metadata it contains %s: read as the heights that have them "
                        "(labels=ignore reads its luma)",
                        path,
                        label->kind == WR_LABEL_SLOPES ? "slopes" : "normals, being a normal map");
        return heights_of_map(session, label, path, like, err);
    }
    const bool ranged = labels && wr_image_rows_apply_range(rows);
    WrField *field = wr_import_rows(rows, wr_field_width(like), wr_field_height(like),
                                    wr_field_wrap_u(like), wr_field_wrap_v(like), err);
    if (!field) return NULL;
    wr_session_note_read(session, path, image);
    if (ranged) note_range(session, image, path);
    return field;
}

/* Table of a picture: its size, and the edge modes of its label. */
static WrField *table_of(const WrDocument *document, const WrImage *image, bool labels,
                         WrError *err)
{
    const WrImageLabel *label = &image->label;
    const WrField *old = document->layers[0].heights;
    WrWrap wrap[2] = { wr_field_wrap_u(old), wr_field_wrap_v(old) };
    for (int k = 0; labels && label->wrapped && is_alone(document) && k < 2; k++)
        wrap[k] = label->clamp[k] ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
    return wr_field_new(image->width, image->height, wrap[0], wrap[1], 0, err);
}

/* Set the cell size from the label, unless it is the default that every file has. */
static void take_cell(WrSession *session, const WrImageLabel *label, const char *path)
{
    WrCellSize cell = { label->cell[0], label->cell[1], label->mm, label->mm ? label->height : 1 };
    if (!label->sized || !wr_cell_size_given(&cell)) return;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->cell = cell;
    wr_session_replace_scene(session, scene);
    wr_session_note(session, "%s: by its metadata the cell is %g x %g %s, which is used", path,
                    cell.w, cell.h, cell.mm ? "mm" : "scene units");
}

static bool run_image(WrSession *session, WrCall *call, WrError *err)
{
    const bool fit = wr_call_given(call, "fit"), labels = wr_call_choice(call, "labels") == 0;
    const char *name = wr_call_arg(call, "FILE")->text;
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer) return false;
    const WrField *old = layer->heights;
    char *path = wr_session_input_path(session, name);
    const WrImageRequest wish = wr_call_request(call);
    WrImageRows *rows = NULL;
    if (wr_session_check_sha256(call, path, err)) rows = wr_image_rows_open(path, &wish, err);
    const WrImage *image = rows ? wr_image_rows_head(rows) : NULL;
    WrField *like = !image ? NULL
                    : fit  ? wr_field_share(old)
                           : table_of(session->state.document, image, labels, err);
    WrField *field = like ? wr_session_heights_of(session, rows, path, labels, like, err) : NULL;
    wr_field_free(like);
    bool good = field != NULL;
    if (good && (fit || wr_field_alike(field, old))) wr_session_put_heights(session, layer, field);
    else if (good) good = replace_table(session, layer, field, err);
    if (good && !fit && labels) take_cell(session, &image->label, path);
    wr_free(path);
    wr_image_rows_close(rows);
    return good;
}

static const char *labels_name(int i)
{
    static const char *const names[] = { "use", "ignore" };
    return i >= 0 && i < 2 ? names[i] : NULL;
}

static const char *fit_name(int i)
{
    return i == 0 ? "table" : NULL;
}

static const WrArgSpec args_table[] = {
    { PLACE("WxH"), .type = WR_ARG_SIZE, .low = 1, .high = WR_FIELD_MAX, .unit = "texels",
      .help = "columns and rows" },
    { .name = "wrap",
      .type = WR_ARG_CHOICE,
      .choice = wr_document_wrap_name,
      .fallback_text = "periodic",
      .help = "continuation beyond the edges. periodic: the table repeats; the others: the edge "
              "value is used along u, v, or both" },
    { 0 }
};

static const WrArgSpec args_fill[] = { { PLACE("F"), .type = WR_ARG_NUMBER, .low = -WR_BIG_HEIGHT,
                                         .high = WR_BIG_HEIGHT, .help = "the height" },
                                       { 0 } };

static const WrArgSpec args_grid[] = { { .name = "cells",
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
                                         .help = "width of the lines" },
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

static const WrArgSpec args_image[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "any picture" },
    { .name = "fit",
      .type = WR_ARG_CHOICE,
      .choice = fit_name,
      .help = "table: resample the picture to the table's size; left out, the table takes the "
              "picture's size" },
    WR_ARGS_OF_FILE,
    { .name = "labels",
      .type = WR_ARG_CHOICE,
      .choice = labels_name,
      .fallback_text = "use",
      .help = "use: read the metadata that export stored, the range of heights or that it is a "
              "normal map; ignore: read plain codes" },
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "SHA-256 of the file; a file with other content is an error" },
    { 0 }
};

static const WrArgSpec args_open[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "a document, or an SVG file" },
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "SHA-256 of the file; a file with other content is an error" },
    { 0 }
};

/* ---- the rows ---- */

const WrCommand wr_command_table = {
    .name = "table",
    .kind = WR_CLASS_EDIT,
    .args = args_table,
    .run = run_table,
    .help = "create a table of heights 0",
    .details = "The table has one layer and no selection. Each layer needs 4 bytes per texel in "
               "tiles whose heights differ: 1.1 GB for 16384x16384. A command needs up to 9 times "
               "that in addition while it runs; most need 1 or 2 times.",
    .example = "table 512x256 wrap=clamp-v"
};

const WrCommand wr_command_fill = { .name = "fill",
                                    .kind = WR_CLASS_EDIT,
                                    .args = args_fill,
                                    .run = run_fill,
                                    .help = "set all heights to a constant",
                                    .example = "fill 0.5" };

const WrCommand wr_command_grid = {
    .name = "grid",
    .kind = WR_CLASS_EDIT,
    .args = args_grid,
    .run = run_grid,
    .help = "replace the heights by a grid of lines",
    .details = "The lines lie on the boundaries of the cells. A texel is high if along either axis "
               "the offset p of its centre from the nearest boundary, to the right or downwards, "
               "satisfies -width/2 <= p < width/2; so the pattern is exact and periodic.",
    .example = "grid cells=4x4 width=6 high=0.5"
};

const WrCommand wr_command_open = {
    .name = "open",
    .kind = WR_CLASS_EDIT,
    .args = args_open,
    .run = run_open,
    .help = "open a document",
    .details = "Replaces layers, selection and scene. An SVG file opens as a table with the "
               "proportions of its page, 1024 texels on the longer side, and the drawing as a "
               "generator layer; the scene stays. In a script, the path is relative to the script.",
    .example = "open bricks.exr"
};

const WrCommand wr_command_image = {
    .name = "image",
    .kind = WR_CLASS_EDIT,
    .args = args_image,
    .run = run_image,
    .help = "read the heights from a picture",
    .details =
        "8-bit and 16-bit pictures are read as 0..1, float pictures as their values; colours are "
        "converted to the Rec. 709 luma of the codes. A file written by export is read by its "
        "metadata: codes become the heights they stand for, a normal map is integrated. The table "
        "keeps its wrap. In a script, the path is relative to the script.",
    .example = "image bricks.png fit=table"
};
