/* The command copy: the selection as a file for `picture paste`. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"
#include "image/image.h"

enum { OF_LAYER, OF_COMPOSITE };
static const char *const sources[] = { "layer", "composite", NULL };

typedef struct Copying {
    const WrField *heights, *cover, *selection; /* the last two NULL: 1 */
    WrSelectBox box;
    const char *path;
} Copying;

static void read_row(const WrField *field, const WrSelectBox *box, int y, float *out)
{
    if (field) {
        wr_field_read(field, box->i, box->j + y, box->count_i, 1, out, (size_t)box->count_i);
        return;
    }
    for (int x = 0; x < box->count_i; x++) out[x] = 1.0f;
}

/* Interleaved row: each height, and its weight = selection times coverage. */
static void make_row(const Copying *copy, int y, float *parts, float *out)
{
    const int n = copy->box.count_i;
    float *cover = parts + n, *selection = parts + 2 * (size_t)n;
    read_row(copy->heights, &copy->box, y, parts);
    read_row(copy->cover, &copy->box, y, cover);
    read_row(copy->selection, &copy->box, y, selection);
    for (int x = 0; x < n; x++) {
        out[2 * (size_t)x] = parts[x];
        out[2 * (size_t)x + 1] = cover[x] * selection[x];
    }
}

static float *parts_of(const Copying *copy, WrError *err)
{
    return wr_try_alloc((size_t)copy->box.count_i, 5 * sizeof(float), "rows of what is copied",
                        err);
}

static bool rows(void *ctx, int y, int count, void *out, WrError *err)
{
    const Copying *copy = ctx;
    float *parts = parts_of(copy, err);
    for (int k = 0; parts && k < count; k++)
        make_row(copy, y + k, parts, (float *)out + 2 * (size_t)k * (size_t)copy->box.count_i);
    wr_free(parts);
    return parts != NULL;
}

/* Read-back check: the file's values equal the copied ones. */
static bool seen(void *ctx, int y, int count, const float *values, bool exact, WrError *err)
{
    const Copying *copy = ctx;
    const size_t n = 2 * (size_t)copy->box.count_i;
    float *parts = parts_of(copy, err), *row = parts ? parts + 3 * (size_t)copy->box.count_i : NULL;
    bool same = parts != NULL;
    for (int k = 0; same && exact && k < count; k++) {
        make_row(copy, y + k, parts, row);
        for (size_t x = 0; same && x < n; x++)
            same =
                values[(size_t)k * n + x] == row[x] ||
                wr_fail(err, "%s: row %d does not read back as it was written", copy->path, y + k);
    }
    wr_free(parts);
    return same;
}

static bool run_copy(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    const WrLayer *layer = &document->layers[document->active];
    Copying copy = { .heights = layer->on_mask ? layer->mask : layer->heights,
                     .cover = layer->on_mask ? NULL : layer->cover,
                     .selection = document->selection,
                     .path = wr_call_arg(call, "FILE")->text };
    if (wr_call_choice(call, "of") == OF_COMPOSITE) {
        copy.heights = wr_document_whole(document, session->options.pool, err);
        if (!copy.heights) return false;
        copy.cover = NULL;
    }
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    copy.box = (WrSelectBox){ 0, 0, wr_field_width(copy.heights), wr_field_height(copy.heights) };
    if (copy.selection && !wr_select_box(copy.selection, &copy.box))
        return wr_fail(err, "nothing is inside the selection that could be copied");
    if (!wr_image_can_write(copy.path, WR_PIXEL_F32, 2, true, err)) return false;
    const WrImageOut out = { .width = copy.box.count_i,
                             .height = copy.box.count_j,
                             .channels = 2,
                             .type = WR_PIXEL_F32,
                             .data = true,
                             .rows = rows,
                             .seen = seen,
                             .ctx = &copy };
    return wr_image_write(copy.path, &out, 1, err);
}

static const WrArgSpec args_copy[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "an OpenEXR or TIFF file, which hold floats" },
    { .name = "of",
      .type = WR_ARG_CHOICE,
      .words = sources,
      .fallback_text = "layer",
      .help = "the active layer (its mask, where edits go there), or all that is shown" },
    { 0 }
};

const WrCommand wr_command_copy = {
    .name = "copy",
    .kind = WR_CLASS_OUTPUT,
    .args = args_copy,
    .run = run_copy,
    .help = "write the heights that are selected into a file",
    .details =
        "The file is as large as the box round the selection; its alpha says how much of each "
        "texel is selected. `picture paste` puts it anywhere, in any document.",
    .example = "copy piece.exr"
};
