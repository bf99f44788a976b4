#include "document/document_file.h"
#include "document/ora.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/document.h"
#include "document/image_rows.h"
#include "document/ora_show.h"
#include "document/ora_stack.h"
#include "document/ora_zip.h"
#include "field/field.h"
#include "image/image.h"
#include "image/icc_profile.h"
#include "scene/objects.h"
#include "system/fd.h"

#include <errno.h>
#include <string.h>

#define MERGED "mergedimage.png"
#define DOS_DATE 0x21 /* 1 January 1980: files contain no time of saving */

/* Pictures are encoded when the archive reaches them, so that only one is in memory at a time. */
typedef struct Entry {
    struct Saving *to;
    char *name; /* in the archive; owned */
    WrImageOut picture;
    const WrImage *image;                  /* a picture of the scene */
    const WrField *heights, *cover, *mask; /* source of its rows; the last two may be NULL */
    WrOraShowing showing;
    char *bytes; /* the encoded file, while it is read; owned */
    size_t length, at;
    bool known;     /* `length` is valid */
    WrHash content; /* of the file */
    bool text;      /* `bytes` are kept: they cannot be encoded again */
} Entry;

typedef struct Saving {
    const WrDocument *document;
    zip_t *archive;
    WrOraSink sink;
    WrOraRange range; /* of heights in previews */
    WR_ARRAY(Entry *) entries;
    WrText stack, scene;
    WrImage *mesh;      /* the scene's meshes, as a picture; owned; or NULL */
    bool composite;     /* there is a topmost layer with the composite for other programs */
    int lowest;         /* index of the lowest visible layer, -1: none */
    WrField *ground;    /* that layer blended onto the empty ground; owned */
    int packed;         /* entries encoded so far */
    uint8_t *thumbnail; /* RGBA */
    uint8_t profile[WR_SRGB_PROFILE_SIZE];
    WrError err; /* of a picture, since the archive library cannot pass it on */
} Saving;

/* ---- pixel rows ---- */

static bool float_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const Entry *entry = ctx;
    int width = wr_field_width(entry->heights);
    wr_field_read(entry->heights, 0, y, width, rows, out, (size_t)width);
    return true;
}

static bool image_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Entry *entry = ctx;
    (void)err;
    wr_image_rows_out(entry->image, entry->picture.channels, y, rows, out);
    return true;
}

/* Grey, grey, grey, alpha; not premultiplied. */
static bool preview_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Entry *entry = ctx;
    int width = wr_field_width(entry->heights);
    size_t pitch = (size_t)width, count = pitch * (size_t)rows;
    float *values = wr_try_alloc(3 * count, sizeof *values, "rows of a picture", err);
    if (!values) return false;
    float *cover = values + count, *mask = cover + count;
    wr_field_read(entry->heights, 0, y, width, rows, values, pitch);
    if (entry->cover) wr_field_read(entry->cover, 0, y, width, rows, cover, pitch);
    if (entry->mask) wr_field_read(entry->mask, 0, y, width, rows, mask, pitch);
    uint16_t *codes = out;
    for (size_t i = 0; i < count; i++) {
        double grey, alpha;
        wr_ora_show(entry->showing, &entry->to->range, values[i], entry->cover ? cover[i] : 1.0f,
                    entry->mask ? mask[i] : 1.0f, &grey, &alpha);
        codes[4 * i] = codes[4 * i + 1] = codes[4 * i + 2] = (uint16_t)(65535.0 * grey + 0.5);
        codes[4 * i + 3] = (uint16_t)(65535.0 * alpha + 0.5);
    }
    wr_free(values);
    return true;
}

static bool thumbnail_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const Entry *entry = ctx;
    size_t row = (size_t)entry->picture.width * 4;
    memcpy(out, entry->to->thumbnail + (size_t)y * row, (size_t)rows * row);
    return true;
}

/* ---- the archive ---- */

static bool render(Entry *entry)
{
    if (entry->bytes) return true;
    Saving *to = entry->to;
    WrProgressPart part;
    double all = to->entries.count, from = entry->known ? to->packed / all : to->packed++ / all;
    const WrProgress *whole = wr_progress_enter(&part, from, from + 1.0 / all);
    bool good =
        wr_image_write_bytes(entry->name, &entry->picture, &entry->bytes, &entry->length, &to->err);
    wr_progress_set(whole);
    if (!good) return false;
    entry->known = true;
    entry->content = wr_hash_bytes(entry->bytes, entry->length, (WrHash){ 0 });
    return true;
}

static zip_int64_t answer_error(void *data, zip_uint64_t length)
{
    int codes[2] = { ZIP_ER_INTERNAL, 0 };
    if (length < sizeof codes) return -1;
    memcpy(data, codes, sizeof codes);
    return sizeof codes;
}

/* Callback of the archive library for a picture. */
static zip_int64_t on_source(void *ctx, void *data, zip_uint64_t length, zip_source_cmd_t command)
{
    Entry *entry = ctx;
    if (command == ZIP_SOURCE_SUPPORTS)
        return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE,
                                              ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR, ZIP_SOURCE_FREE,
                                              -1);
    if (command == ZIP_SOURCE_ERROR) return answer_error(data, length);
    if (command == ZIP_SOURCE_STAT) {
        if (!entry->known && !render(entry)) return -1;
        zip_stat_t *told = data;
        zip_stat_init(told);
        told->size = entry->length;
        told->valid = ZIP_STAT_SIZE;
        return sizeof *told;
    }
    if (command == ZIP_SOURCE_OPEN) {
        entry->at = 0;
        return render(entry) ? 0 : -1;
    }
    if (command == ZIP_SOURCE_READ) {
        if (wr_progress_stopped()) return -1;
        size_t left = entry->length - entry->at, take = left < length ? left : (size_t)length;
        memcpy(data, entry->bytes + entry->at, take);
        entry->at += take;
        return (zip_int64_t)take;
    }
    if (command == ZIP_SOURCE_CLOSE && !entry->text) {
        wr_free(entry->bytes);
        entry->bytes = NULL;
    }
    return 0;
}

/* All entries are stored: the pictures are already compressed, and the first entry must be stored. */
static bool add_source(Saving *to, const char *name, zip_source_t *source, WrError *err)
{
    zip_int64_t index = source ? zip_file_add(to->archive, name, source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0 && source) zip_source_free(source);
    if (index < 0 ||
        zip_set_file_compression(to->archive, (zip_uint64_t)index, ZIP_CM_STORE, 0) != 0 ||
        zip_file_set_dostime(to->archive, (zip_uint64_t)index, 0, DOS_DATE, 0) != 0)
        return wr_fail(err, "%s", zip_strerror(to->archive));
    return true;
}

static bool add_entry(Saving *to, Entry made, WrError *err)
{
    Entry *entry = wr_alloc(1, sizeof *entry);
    *entry = made;
    entry->to = to;
    entry->picture.ctx = entry;
    wr_array_push(&to->entries, entry);
    zip_error_t trouble;
    zip_error_init(&trouble);
    zip_source_t *source = zip_source_function_create(on_source, entry, &trouble);
    zip_error_fini(&trouble);
    return add_source(to, entry->name, source, err);
}

/* Adds bytes that are already encoded; they are copied. */
static bool add_text(Saving *to, const char *name, const char *text, size_t length, WrError *err)
{
    Entry entry = { .name = wr_strdup(name),
                    .bytes = wr_strndup(text, length),
                    .length = length,
                    .known = true,
                    .text = true,
                    .content = wr_hash_bytes(text, length, (WrHash){ 0 }) };
    return add_entry(to, entry, err);
}

/* Adds a float picture; takes ownership of the name. */
static bool add_floats(Saving *to, char *name, const WrField *field, WrError *err)
{
    Entry entry = { .name = name,
                    .heights = field,
                    .picture = { .width = wr_field_width(field),
                                 .height = wr_field_height(field),
                                 .channels = 1,
                                 .type = WR_PIXEL_F32,
                                 .data = true,
                                 .rows = float_rows } };
    return add_entry(to, entry, err);
}

/* Adds a picture for other programs, of heights alone or as a layer. Some programs ask for the profile of each
   16-bit layer without one. */
static bool add_preview(Saving *to, Entry entry, WrError *err)
{
    entry.picture = (WrImageOut){ .width = wr_field_width(entry.heights),
                                  .height = wr_field_height(entry.heights),
                                  .channels = 4,
                                  .type = WR_PIXEL_U16,
                                  .profile = to->profile,
                                  .profile_size = sizeof to->profile,
                                  .rows = preview_rows };
    return add_entry(to, entry, err);
}

/* Adds the picture of a layer. The lowest visible one is opaque and already combined with the ground: other
   programs have no ground of heights 0, and some do not show a layer that adds to nothing. */
static bool add_layer_preview(Saving *to, char *name, int index, WrError *err)
{
    const WrLayer *layer = &to->document->layers[index];
    if (index == to->lowest)
        return add_preview(to, (Entry){ .name = name, .heights = to->ground }, err);
    return add_preview(
        to,
        (Entry){ .name = name,
                 .heights = layer->heights,
                 .cover = layer->filter.op ? layer->heights : layer->cover,
                 .mask = layer->mask,
                 .showing = layer->filter.op ? WR_ORA_HEIGHTS : wr_ora_showing(layer->blend) },
        err);
}

static bool add_image(Saving *to, const WrImage *image, char *name, const char *attribute,
                      int channels, WrError *err)
{
    Entry entry = { .name = name,
                    .image = image,
                    .picture = { .width = image->width,
                                 .height = image->height,
                                 .channels = channels,
                                 .type = WR_PIXEL_F32,
                                 .rows = image_rows } };
    wr_ora_add_attribute(&to->stack, attribute, entry.name);
    return add_entry(to, entry, err);
}

/* ---- contents ---- */

static char *numbered(const char *before, int number, const char *after)
{
    WrText text = { 0 };
    wr_text_addf(&text, "%s%d%s", before, number, after);
    return text.data;
}

/* The pictures of the scene's objects, and its mesh. */
static bool add_scene_images(Saving *to, const WrScene *scene, WrError *err)
{
    if (!wr_scene_meshes_to_image(scene, &to->mesh, err)) return false;
    for (int i = 0; i < wr_scene_object_count(scene) * WR_OBJECT_PICTURES; i++) {
        const int of = i / WR_OBJECT_PICTURES, which = i % WR_OBJECT_PICTURES;
        const WrImage *picture = wr_object_picture(scene, of, which);
        char entry[WR_ORA_PICTURE_NAME], name[WR_ORA_PICTURE_NAME];
        wr_ora_picture_name("data/", of, which, ".exr", entry);
        wr_ora_picture_name("wrinkle:", of, which, "", name);
        if (picture && !add_image(to, picture, wr_strdup(entry), name, 3, err)) return false;
    }
    return !to->mesh || add_image(to, to->mesh, wr_strdup("data/mesh.exr"), "wrinkle:mesh", 1, err);
}

/* Finds the lowest visible layer, and blends it onto the ground. */
static void find_ground(Saving *to)
{
    int count = to->document->layer_count;
    to->lowest = -1;
    for (int i = count - 1; i >= 0; i--)
        if (wr_document_shows(to->document, i)) to->lowest = i;
    if (to->lowest < 0) return;
    WrDocument *alone = wr_document_snapshot(to->document);
    for (int i = count - 1; i >= 0; i--)
        if (i != to->lowest) wr_document_remove(alone, i);
    alone->layers[0].visible = true;
    alone->solo = -1;
    to->ground = wr_field_share(wr_document_field(alone));
    wr_document_free(alone);
}

static bool add_field(Saving *to, const char *attribute, char *name, const WrField *f, WrError *err)
{
    wr_ora_add_attribute(&to->stack, attribute, name);
    return add_floats(to, name, f, err);
}

/* Attributes for other programs, and our own if the values differ. */
static void add_looks(Saving *to, int index)
{
    const WrLayer *layer = &to->document->layers[index];
    WrText *xml = &to->stack;
    bool lowest = index == to->lowest, shown = wr_document_shows(to->document, index);
    wr_ora_add_float(xml, "opacity", lowest ? 1.0f : layer->opacity);
    if (lowest && layer->opacity != 1.0f) wr_ora_add_float(xml, "wrinkle:opacity", layer->opacity);
    wr_ora_add_attribute(xml, "visibility", shown ? "visible" : "hidden");
    if (shown != layer->visible)
        wr_ora_add_attribute(xml, "wrinkle:visible", layer->visible ? "on" : "off");
    wr_ora_add_attribute(xml, "composite-op",
                         lowest ? wr_ora_operation(WR_BLEND_REPLACE)
                                : wr_ora_operation(layer->blend));
}

/* Converts a layer's settings to attributes; the inverse of read_settings in ora_load.c. */
static bool add_layer(Saving *to, int index, WrError *err)
{
    const WrLayer *layer = &to->document->layers[index];
    WrText *xml = &to->stack;
    int number = index + 1;
    char *png = numbered("data/layer", number, ".png");
    wr_text_add(xml, "    <layer");
    wr_ora_add_name(xml, layer->name);
    wr_ora_add_attribute(xml, "src", png);
    wr_text_add(xml, " x=\"0\" y=\"0\"");
    add_looks(to, index);
    if (layer->locked) wr_ora_add_attribute(xml, "edit-locked", "true");
    if (index == to->document->active) wr_ora_add_attribute(xml, "selected", "true");
    if (layer->on_mask) wr_ora_add_attribute(xml, "wrinkle:on-mask", "on");
    wr_ora_add_attribute(xml, "wrinkle:blend", wr_blends[layer->blend].name);
    wr_ora_add_float(xml, "wrinkle:radius", layer->radius);
    wr_ora_add_filter(xml, &layer->filter);
    bool good =
        add_layer_preview(to, png, index, err) &&
        add_field(to, "wrinkle:heights", numbered("data/layer", number, ".exr"), layer->heights,
                  err) &&
        (!layer->cover || add_field(to, "wrinkle:cover", numbered("data/cover", number, ".exr"),
                                    layer->cover, err)) &&
        (!layer->mask ||
         add_field(to, "wrinkle:mask", numbered("data/mask", number, ".exr"), layer->mask, err));
    wr_text_add(xml, "/>\n");
    return good;
}

static bool add_image_attributes(Saving *to, WrError *err)
{
    const WrDocument *document = to->document;
    const WrField *f = document->layers[0].heights;
    char low[WR_NUMBER_SIZE], high[WR_NUMBER_SIZE];
    wr_text_addf(&to->stack,
                 "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<image version=\"0.0.5\" w=\"%d\" "
                 "h=\"%d\" xmlns:wrinkle=\"" WR_ORA_NAMESPACE "\" wrinkle:version=\"%d\" "
                 "wrinkle:wrap=\"%s\" wrinkle:range=\"%s,%s\" wrinkle:active=\"%d\" "
                 "wrinkle:solo=\"%d\" wrinkle:scene=\"data/scene.wrinkle\"",
                 wr_field_width(f), wr_field_height(f), wr_ora_version(document, to->composite),
                 wr_document_wrap_word(wr_field_wrap_u(f), wr_field_wrap_v(f)),
                 wr_number_print_float(to->range.low, low),
                 wr_number_print_float(to->range.high, high), document->active + 1,
                 document->solo + 1);
    if (document->selection && !add_field(to, "wrinkle:selection", wr_strdup("data/selection.exr"),
                                          document->selection, err))
        return false;
    if (!add_scene_images(to, document->scene, err)) return false;
    wr_text_add(&to->stack, ">\n  <stack>\n");
    return true;
}

static bool add_pictures_of_all(Saving *to, WrError *err)
{
    const WrField *f = wr_document_field(to->document);
    Entry thumbnail = { .name = wr_strdup("Thumbnails/thumbnail.png"),
                        .picture = { .channels = 4, .type = WR_PIXEL_U8, .rows = thumbnail_rows } };
    to->thumbnail =
        wr_ora_thumbnail(f, &to->range, &thumbnail.picture.width, &thumbnail.picture.height, err);
    if (!to->thumbnail) {
        wr_free(thumbnail.name);
        return false;
    }
    return add_preview(to, (Entry){ .name = wr_strdup(MERGED), .heights = f }, err) &&
           add_entry(to, thumbnail, err);
}

#define COMPOSITE                                                                                  \
    "    <layer name=\"Composite (hide it to edit the layers below)\" src=\"" MERGED               \
    "\" x=\"0\" y=\"0\" opacity=\"1\" visibility=\"visible\" composite-op=\"svg:src-over\" "       \
    "edit-locked=\"true\" wrinkle:composite=\"on\"/>\n"

static bool fill_archive(Saving *to, WrError *err)
{
    static const char type[] = "image/openraster";
    wr_srgb_profile(to->profile);
    wr_filters_forget();
    find_ground(to);
    to->range = wr_ora_range(to->document);
    to->composite = !wr_ora_agrees(to->document, to->lowest, &to->range);
    if (!wr_filters_carried(err)) return false;
    if (!add_text(to, "mimetype", type, sizeof type - 1, err) || !add_image_attributes(to, err))
        return false;
    if (to->composite) wr_text_add(&to->stack, COMPOSITE);
    for (int i = to->document->layer_count - 1; i >= 0; i--)
        if (!add_layer(to, i, err)) return false;
    wr_text_add(&to->stack, "  </stack>\n</image>\n");
    return add_text(to, "stack.xml", to->stack.data, to->stack.length, err) &&
           add_text(to, "data/scene.wrinkle", wr_text_get(&to->scene), to->scene.length, err) &&
           add_pictures_of_all(to, err);
}

static bool write_archive(Saving *to, WrFileTarget *target, WrError *err)
{
    to->sink = (WrOraSink){ .to = wr_file_sink(target) };
    to->archive = wr_ora_sink_open(&to->sink, err);
    if (!to->archive) return false;
    char why[WR_FILE_WHY];
    bool good = fill_archive(to, err);
    if (good && zip_close(to->archive) != 0)
        good = wr_fail(err, "%s",
                       to->err.text[0]  ? wr_error_message(&to->err)
                       : to->sink.error ? wr_file_why(to->sink.error, why)
                                        : zip_strerror(to->archive));
    else if (good) to->archive = NULL;
    if (to->archive) zip_discard(to->archive);
    return good;
}

/* Verifies that every file in the archive has the written content; the pictures were verified when they were
   encoded. */
static bool verify_archive(const Saving *to, const char *name, int fd, WrError *err)
{
    int again = wr_fd_again(fd);
    if (again < 0) return wr_fail(err, "%s", strerror(errno));
    WrOraZip *zip = wr_ora_zip_take(name, again, err);
    bool good = zip != NULL;
    for (int i = 0; i < to->entries.count && good; i++) {
        const Entry *entry = to->entries.data[i];
        char *bytes;
        size_t length;
        good = wr_ora_zip_read(zip, entry->name, entry->length, &bytes, &length, err);
        if (!good) break;
        if (length != entry->length ||
            !wr_hash_equal(wr_hash_bytes(bytes, length, (WrHash){ 0 }), entry->content))
            good = wr_fail(err, "%s in it does not read back as it was written", entry->name);
        wr_free(bytes);
    }
    wr_ora_zip_close(zip);
    return good;
}

bool wr_ora_save(const WrDocument *document, const char *scene_text, const char *path, WrText *note,
                 WrError *err)
{
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    Saving *to = wr_alloc(1, sizeof *to);
    to->document = document;
    wr_text_add(&to->scene, scene_text);
    bool good = write_archive(to, &target, err) && verify_archive(to, path, target.fd, err);
    if (good && wr_progress_stopped()) good = wr_fail(err, "cancelled");
    if (!good) wr_error_prefix(err, "%s: cannot be written: ", path);
    for (int i = 0; i < to->entries.count; i++) {
        wr_free(to->entries.data[i]->name);
        wr_free(to->entries.data[i]->bytes);
        wr_free(to->entries.data[i]);
    }
    wr_array_free(&to->entries);
    wr_text_fini(&to->stack);
    wr_text_fini(&to->scene);
    wr_field_free(to->ground);
    wr_free(to->thumbnail);
    wr_image_free(to->mesh);
    const bool tells = to->composite && note;
    wr_free(to);
    if (good) {
        good = wr_file_commit(&target, err);
        if (good && tells)
            wr_text_addf(note,
                         "%s: other programs blend some of these layers differently: a topmost "
                         "layer shows them the composite; hide it there to edit the others",
                         path);
        return good;
    }
    wr_file_abort(&target);
    return false;
}
