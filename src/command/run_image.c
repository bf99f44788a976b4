/* image: the heights of a picture, by its values or by the label that export wrote into it. */
#include "command/inner.h"

#include "base/memory.h"
#include "document/document_file.h"
#include "generate/generator.h"

#include <math.h>

static bool same_size(const WrField *a, const WrField *b)
{
    return wr_field_width(a) == wr_field_width(b) && wr_field_height(a) == wr_field_height(b);
}

/* A picture of another size makes the table another; so it can only where there is nothing but one layer. */
static bool replace_table(WrSession *session, WrLayer *layer, WrField *field, WrError *err)
{
    const WrDocument *document = session->state.document;
    if (document->layer_count > 1 || document->selection || layer->mask) {
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

/* The heights that have the normals of a map of ours; a negative height turned them round. */
static WrField *heights_of_map(WrSession *session, const WrImageLabel *label, const char *path,
                               const WrField *like, WrError *err)
{
    const WrGenerator *row = wr_generator_find("picture", "normals");
    WrParamValue values[WR_GENERATOR_PARAMS];
    WrRelief relief = { NULL, NULL };
    wr_generator_defaults(row, values);
    value_of(row, values, "file")->text = path;
    value_of(row, values, "y")->number[0] = label->kind == WR_LABEL_NORMAL_UP ? 1 : 2;
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
    const double last = image->type == WR_PIXEL_U8 ? 255 : 65535;
    wr_session_note(session,
                    "%s: its label tells that codes 0 to %g are heights %g to %g: so they are read "
                    "(labels=ignore reads 0 to 1)",
                    path, last, label->low - label->step * label->zero,
                    label->low + label->step * (last - label->zero));
}

/* The heights of a picture in a table like `like`, by what its label says of it. */
static WrField *heights_of(WrSession *session, WrImageRows *rows, const char *path, bool labels,
                           const WrField *like, WrError *err)
{
    const WrImage *image = wr_image_rows_head(rows);
    const WrImageLabel *label = &image->label;
    if (labels && label->refused[0])
        wr_session_note(session, "%s: its label %s makes no sense and is not used", path,
                        label->refused);
    if (labels && label->kind >= WR_LABEL_NORMAL_UP) {
        wr_session_note(
            session,
            "%s: its label tells that it is a normal map: read as the heights that have "
            "its normals (labels=ignore reads its luma)",
            path);
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

bool wr_run_image(WrSession *session, WrCall *call, WrError *err)
{
    const bool fit = wr_call_given(call, "fit"), labels = wr_call_choice(call, "labels") == 0;
    const char *name = wr_call_arg(call, "FILE")->text;
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer) return false;
    const WrField *old = layer->heights;
    char *path = wr_session_input_path(session, name);
    const WrImageWish wish = wr_call_wish(call);
    WrImageRows *rows = NULL;
    if (wr_session_check_sha256(call, path, err)) rows = wr_image_rows_open(path, &wish, err);
    const WrImage *image = rows ? wr_image_rows_head(rows) : NULL;
    WrField *like = !image ? NULL
                    : fit  ? wr_field_share(old)
                           : wr_field_new(image->width, image->height, wr_field_wrap_u(old),
                                          wr_field_wrap_v(old), 0, err);
    WrField *field = like ? heights_of(session, rows, path, labels, like, err) : NULL;
    wr_field_free(like);
    wr_free(path);
    wr_image_rows_close(rows);
    if (!field) return false;
    if (!same_size(field, old)) return replace_table(session, layer, field, err);
    wr_session_put_heights(session, layer, field);
    return true;
}
