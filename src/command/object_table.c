/* `object set table=FILE`: a table of the object's own, stored as a hidden layer. It can therefore be painted,
   masked, undone and saved like any layer, and a document stays one file with one table size. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

#include <string.h>

static void note_size(WrSession *session, const char *path, int width, int height,
                      const WrField *like)
{
    if (width == wr_field_width(like) && height == wr_field_height(like)) return;
    wr_session_note(session, "%s is %dx%d: resampled to the table's %dx%d", path, width, height,
                    wr_field_width(like), wr_field_height(like));
}

/* The heights as a one-channel picture. */
static WrImage *image_of(const WrField *field, WrError *err)
{
    const int width = wr_field_width(field), height = wr_field_height(field);
    WrImage *image = wr_image_new(width, height, 1, err);
    if (!image) return NULL;
    image->type = WR_PIXEL_F32;
    wr_field_read(field, 0, 0, width, height, image->data, (size_t)width);
    return image;
}

/* The composite of an OpenRaster document, whose pictures are for display only. */
static WrField *heights_of_ora(WrSession *session, const char *path, const WrField *like,
                               WrError *err)
{
    const WrSessionOptions options = { .pool = session->options.pool,
                                       .note = session->options.note,
                                       .note_ctx = session->options.note_ctx };
    WrSession *other = wr_session_new(&options);
    WrImage *image = NULL;
    WrField *made = NULL;
    if (wr_session_load(other, path, err))
        image = image_of(wr_document_composite(other->state.document, session->options.pool), err);
    if (image) {
        note_size(session, path, image->width, image->height, like);
        made = wr_import_heights(image, wr_field_width(like), wr_field_height(like),
                                 wr_field_wrap_u(like), wr_field_wrap_v(like), err);
    }
    wr_image_free(image);
    wr_session_free(other);
    return made;
}

/* In a document that is an EXR file, the first part is the composite, as in any picture. */
static WrField *heights_of_picture(WrSession *session, const char *path, const WrField *like,
                                   WrError *err)
{
    const WrImageRequest wish = { 0 };
    WrImageRows *rows = wr_image_rows_open(path, &wish, err);
    if (!rows) return NULL;
    const WrImage *head = wr_image_rows_head(rows);
    const int width = head->width, height = head->height;
    WrField *made = wr_session_heights_of(session, rows, path, true, like, err);
    if (made) note_size(session, path, width, height, like);
    wr_image_rows_close(rows);
    return made;
}

/* "shell" of "pictures/shell.exr"; "shell 2" if there is a layer of that name. The caller frees it. */
static char *layer_name(const WrDocument *document, const char *path)
{
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    size_t length = dot && dot > base ? (size_t)(dot - base) : strlen(base);
    if (length > WR_LAYER_NAME_MAX - 8) length = WR_LAYER_NAME_MAX - 8;
    while (length > 0 && ((unsigned char)base[length] & 0xC0) == 0x80) length--;
    WrText text = { 0 };
    for (int number = 1;; number++) {
        int same = 0;
        wr_text_clear(&text);
        wr_text_add_n(&text, base, length);
        if (number > 1) wr_text_addf(&text, " %d", number);
        for (int i = 0; i < document->layer_count; i++)
            same += strcmp(document->layers[i].name, wr_text_get(&text)) == 0;
        if (same == 0) return text.data;
    }
}

bool wr_object_take_table(WrSession *session, WrCall *call, WrScene *scene, WrError *err)
{
    const char *name = wr_call_arg(call, "table")->text;
    WrDocument *document = session->state.document;
    if (!wr_call_given(call, "table")) {
        if (!wr_call_given(call, "sha256")) return true;
        return wr_fail(err, "sha256= belongs to a table=");
    }
    if (wr_call_given(call, "layer"))
        return wr_fail(err, "table= and layer= do not go together: the file becomes the layer");
    if (document->layer_count == WR_LAYERS_MAX)
        return wr_fail(err, "a document has up to %d layers", WR_LAYERS_MAX);
    const WrField *like = document->layers[0].heights;
    char *path = wr_session_input_path(session, name);
    WrField *heights = NULL;
    if (wr_session_check_sha256(call, path, err))
        heights = wr_ora_recognise(path) ? heights_of_ora(session, path, like, err)
                                         : heights_of_picture(session, path, like, err);
    wr_free(path);
    if (!heights) return false;
    char *own = layer_name(document, name);
    WrLayer layer = wr_layer_new(own, like);
    wr_field_free(layer.heights);
    wr_field_free(layer.cover);
    layer.heights = heights;
    layer.cover = NULL;
    layer.visible = false;
    wr_document_insert(document, document->layer_count, layer);
    document->active = document->layer_count - 1;
    wr_free(scene->layer);
    scene->layer = own;
    return true;
}
