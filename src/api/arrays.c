/* Arrays of the C interface: heights, maps, pictures and files in the caller's memory. */
#include "api/api_internal.h"
#include "base/array.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "command/variants.h"
#include "document/document.h"
#include "export/export.h"
#include "export/preview.h"
#include "field/field.h"
#include "field/scheme.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "system/path.h"

#include <math.h>
#include <string.h>

/* ---- the caller's memory ---- */

static const WrPixelType pixel_types[] = {
    [WR_DOC_F32] = WR_PIXEL_F32, [WR_DOC_U16] = WR_PIXEL_U16, [WR_DOC_U8] = WR_PIXEL_U8
};
static const size_t type_bytes[] = { [WR_DOC_F32] = 4, [WR_DOC_U16] = 2, [WR_DOC_U8] = 1 };

/* Replaces packed strides by their values. Errors: no data, a type or strides that do not exist, another size than expected. */
static bool check_array(const WrDocArray *given, int width, int height, int channels,
                        WrDocArray *out, WrError *err)
{
    *out = *given;
    if (!out->data) return wr_fail(err, "array: data is NULL");
    if (out->type < 0 || (size_t)out->type >= WR_LENGTH(type_bytes))
        return wr_fail(err, "array: type %d: must be WR_DOC_F32, WR_DOC_U16 or WR_DOC_U8",
                       (int)out->type);
    if (out->width != width || out->height != height || out->channels != channels)
        return wr_fail(err, "array of %dx%d with %d channels: must be %dx%d with %d",
                       (int)out->width, (int)out->height, (int)out->channels, width, height,
                       channels);
    const ptrdiff_t bytes = (ptrdiff_t)type_bytes[out->type];
    if (out->pixel_stride == 0) out->pixel_stride = bytes * channels;
    if (out->row_stride == 0) out->row_stride = out->pixel_stride * width;
    if (out->pixel_stride % bytes || out->row_stride % bytes ||
        (uintptr_t)out->data % (uintptr_t)bytes)
        return wr_fail(err, "array: data and strides must be multiples of %d bytes", (int)bytes);
    return true;
}

static char *pixel(const WrDocArray *array, int x, int y)
{
    return (char *)array->data + y * array->row_stride + x * array->pixel_stride;
}

/* Copies a row of packed values of the array's type. */
static void put_row(const WrDocArray *array, int y, const void *row)
{
    const size_t bytes = type_bytes[array->type] * (size_t)array->channels;
    if (array->pixel_stride == (ptrdiff_t)bytes) {
        memcpy(pixel(array, 0, y), row, bytes * (size_t)array->width);
        return;
    }
    for (int x = 0; x < array->width; x++)
        memcpy(pixel(array, x, y), (const char *)row + (size_t)x * bytes, bytes);
}

/* ---- heights ---- */

/* Codes of heights: low is 0, high is 1. */
static void put_codes(const WrDocArray *array, int y, float *row, double low, double high)
{
    const double scale = high > low ? 1 / (high - low) : 0;
    uint16_t codes[WR_IMAGE_MAX];
    for (int x = 0; x < array->width; x++) row[x] = (float)(((double)row[x] - low) * scale);
    wr_image_codes(pixel_types[array->type], row, (size_t)array->width, codes, NULL);
    put_row(array, y, codes);
}

/* The composite of a group's members. */
static WrField *group_heights(const WrDocument *document, int group, WrPool *pool)
{
    WrDocument *copy = wr_document_snapshot(document);
    const int layer = wr_document_rasterize_group(copy, group, pool);
    WrField *heights = wr_field_share(copy->layers[layer].heights);
    wr_document_free(copy);
    return heights;
}

/* The caller frees them. */
static WrField *heights_of(WrDoc *doc, int layer, WrError *err)
{
    const WrDocument *document = wr_session_document(doc->session);
    WrPool *pool = wr_api_pool(doc);
    if (layer == -1) {
        const WrField *composite = wr_document_whole(document, pool, err);
        return composite ? wr_field_share(composite) : NULL;
    }
    if (layer < 0 || layer >= document->layer_count) {
        wr_fail(err, "layer %d: must be 0..%d, or -1 for the composite", layer,
                document->layer_count - 1);
        return NULL;
    }
    if (document->layers[layer].is_group) return group_heights(document, layer, pool);
    return wr_field_share(document->layers[layer].heights);
}

static bool read_heights(const WrField *field, const WrDocArray *given, double *low, double *high,
                         WrError *err)
{
    WrDocArray array;
    const int width = wr_field_width(field), height = wr_field_height(field);
    if (!check_array(given, width, height, 1, &array, err)) return false;
    const bool codes = array.type != WR_DOC_F32;
    if (codes && (!low || !high || !isfinite(*high - *low) || *low > *high))
        return wr_fail(err, "codes of heights need low <= high, both finite");
    float range[2];
    if (codes && *low == *high) {
        wr_field_range(field, &range[0], &range[1]);
        *low = (double)range[0], *high = (double)range[1];
    }
    float *row = wr_alloc_unset((size_t)width, sizeof *row);
    for (int y = 0; y < height; y++) {
        wr_field_read(field, 0, y, width, 1, row, (size_t)width);
        if (codes) put_codes(&array, y, row, *low, *high);
        else put_row(&array, y, row);
    }
    wr_free(row);
    return !wr_progress_stopped() || wr_fail(err, "cancelled");
}

bool wr_doc_heights(WrDoc *doc, int32_t layer, const WrDocArray *array, double *low, double *high,
                    WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    WrField *field = heights_of(doc, layer, &call.err);
    const bool good = field && read_heights(field, array, low, high, &call.err);
    wr_field_free(field);
    return wr_api_end(&call, good, error);
}

/* Packed floats of the caller's array. NULL and an error: no memory. */
static float *heights_from(const WrDocArray *array, double low, double high, WrError *err)
{
    const size_t width = (size_t)array->width;
    const double last = wr_pixel_type_max(pixel_types[array->type]);
    float *packed =
        wr_try_alloc_unset(width * (size_t)array->height, sizeof *packed, "heights", err);
    for (int y = 0; packed && y < array->height; y++)
        for (int x = 0; x < array->width; x++) {
            const void *from = pixel(array, x, y);
            float *to = &packed[(size_t)y * width + (size_t)x];
            if (array->type == WR_DOC_F32) *to = *(const float *)from;
            else
                *to = (float)(low + (high - low) / last *
                                        (array->type == WR_DOC_U16 ? *(const uint16_t *)from
                                                                   : *(const uint8_t *)from));
        }
    return packed;
}

/* Through a file and a command, so that history, journal and saved scripts have it like any other picture. */
static bool write_heights(WrDoc *doc, const WrDocArray *given, double low, double high,
                          WrError *err)
{
    WrDocArray array;
    if (given->width < 1 || given->height < 1 || given->width > WR_FIELD_MAX ||
        given->height > WR_FIELD_MAX)
        return wr_fail(err, "array of %dx%d: must be 1..%d along each side", (int)given->width,
                       (int)given->height, WR_FIELD_MAX);
    if (!check_array(given, given->width, given->height, 1, &array, err)) return false;
    if (array.type != WR_DOC_F32 && !(isfinite(high - low) && low < high))
        return wr_fail(err, "codes of heights need low < high, both finite");
    float *packed = heights_from(&array, low, high, err);
    if (!packed) return false;
    WrText path = { 0 }, line = { 0 };
    bool written = wr_api_scratch(doc, &path, err);
    if (written) wr_text_addf(&path, "/heights-%d.exr", ++doc->files);
    written = written && wr_image_write_pixels(wr_text_get(&path), array.width, array.height, 1,
                                               WR_PIXEL_F32, true, packed, err);
    wr_free(packed);
    if (written) wr_text_addf(&line, "image \"%s\" labels=ignore", wr_text_get(&path));
    const bool good = written && wr_session_run(doc->session, wr_text_get(&line), err);
    wr_text_fini(&path);
    wr_text_fini(&line);
    return good;
}

bool wr_doc_set_heights(WrDoc *doc, const WrDocArray *array, double low, double high,
                        WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, write_heights(doc, array, low, high, &call.err), error);
}

/* ---- samples ---- */

static bool sample(WrDoc *doc, const char *name, const double *uv, size_t count, double *out,
                   WrError *err)
{
    const WrDocument *document = wr_session_document(doc->session);
    const WrField *field = wr_document_whole(document, wr_api_pool(doc), err);
    const int scheme = name ? wr_scheme_find(name) : (int)document->scene->scheme;
    if (!field) return false;
    if (scheme < 0) return wr_fail(err, "scheme \"%.40s\": `help bump` lists them", name);
    enum { BLOCK = 256 };
    double u[BLOCK], v[BLOCK], f[3][BLOCK];
    for (size_t i = 0; i < count; i += BLOCK) {
        const size_t n = count - i < BLOCK ? count - i : BLOCK;
        for (size_t k = 0; k < n; k++) u[k] = uv[2 * (i + k)], v[k] = uv[2 * (i + k) + 1];
        wr_field_sample(field, scheme, n, u, v, f[0], f[1], f[2]);
        for (size_t k = 0; k < n; k++)
            for (size_t c = 0; c < 3; c++) out[3 * (i + k) + c] = f[c][k];
    }
    return true;
}

bool wr_doc_sample(WrDoc *doc, const char *scheme, const double *uv, size_t count, double *out,
                   WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, sample(doc, scheme, uv, count, out, &call.err), error);
}

/* ---- maps and files ---- */

/* An export as words: a kind and its options. */
typedef struct Export {
    char *text; /* owned; the words are parts of it */
    const WrExportKind *kind;
    WrExportOptions options;
} Export;

#define WORDS_MAX (WR_EXPORT_OPTIONS + 1)

static const char *kind_name(const void *ctx, int i)
{
    (void)ctx;
    return i < WR_EXPORT_KIND_COUNT ? wr_export_kinds[i].name : NULL;
}

static bool parse_export(const char *kind, Export *out, WrError *err)
{
    const char *words[WORDS_MAX];
    int count = 0;
    *out = (Export){ .text = wr_strdup(kind), .options = wr_export_default() };
    for (char *p = out->text; *(p += strspn(p, " "));) {
        if (count == WORDS_MAX) return wr_fail(err, "%.40s: more than %d options", kind, WORDS_MAX);
        words[count++] = p;
        p += strcspn(p, " ");
        if (*p) *p++ = '\0';
    }
    if (count == 0) return wr_fail(err, "no kind of export is given, such as \"normal+y\"");
    out->kind = wr_export_find(words[0]);
    if (!out->kind) return wr_fail_word(err, "kind", words[0], kind_name, NULL);
    return wr_export_words(out->kind, words + 1, count - 1, &out->options, err);
}

static void fill_info(const WrExportValues *values, WrDocMap *info)
{
    const WrExportReport *report = &values->report;
    *info = (WrDocMap){ .width = values->width,
                        .height = values->height,
                        .channels = values->channels };
    if (report->ranged) info->low = report->code_low, info->high = report->code_high;
    memcpy(info->names, values->names, sizeof info->names);
}

static bool copy_map(const WrExportValues *values, const WrDocArray *given, WrError *err)
{
    WrDocArray array;
    if (!check_array(given, values->width, values->height, values->channels, &array, err))
        return false;
    const size_t row = (size_t)values->width * (size_t)values->channels * type_bytes[array.type];
    for (int y = 0; y < values->height; y++)
        put_row(&array, y, (const char *)values->data + (size_t)y * row);
    return true;
}

/* array: NULL for the size only */
static bool make_map(WrDoc *doc, const char *kind, const WrDocArray *array, WrDocMap *info,
                     WrError *err)
{
    static const int depths[] = { [WR_DOC_F32] = 32, [WR_DOC_U16] = 16, [WR_DOC_U8] = 8 };
    const WrDocument *document = wr_session_document(doc->session);
    WrPool *pool = wr_api_pool(doc);
    WrExportValues values = { 0 };
    Export export;
    WrDocArray checked;
    bool good = parse_export(kind, &export, err);
    if (good && array)
        good = check_array(array, array->width, array->height, array->channels, &checked, err);
    if (good && array) export.options.depth = depths[array->type];
    good = good && wr_document_whole(document, pool, err) &&
           wr_export_values(export.kind, document, &export.options, !array, pool, &values, err) &&
           (!wr_progress_stopped() || wr_fail(err, "cancelled")) &&
           (!array || copy_map(&values, array, err));
    if (good && info) fill_info(&values, info);
    wr_free(values.data);
    wr_free(export.text);
    return good;
}

bool wr_doc_map_info(WrDoc *doc, const char *kind, WrDocMap *info, WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, make_map(doc, kind, NULL, info, &call.err), error);
}

bool wr_doc_map(WrDoc *doc, const char *kind, const WrDocArray *array, WrDocMap *info,
                WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, make_map(doc, kind, array, info, &call.err), error);
}

static bool export_file(WrDoc *doc, const char *kind, const char *path, WrError *err)
{
    const WrDocument *document = wr_session_document(doc->session);
    Export export;
    const bool good =
        parse_export(kind, &export, err) &&
        wr_session_check_export(doc->session, export.kind, path, err) &&
        wr_document_whole(document, wr_api_pool(doc), err) &&
        wr_export(export.kind, document, &export.options, wr_api_pool(doc), path, NULL, err);
    wr_free(export.text);
    return good;
}

typedef struct FileExport {
    WrDoc *doc;
    const char *kind, *path;
} FileExport;

static bool export_variant(void *ctx, const char *variant, WrError *err)
{
    const FileExport *export = ctx;
    char *name = wr_variant_fill(export->path, variant);
    char *out = wr_session_output_name(export->doc->session, name, err);
    const bool good = out && export_file(export->doc, export->kind, out, err);
    wr_free(name);
    wr_free(out);
    return good;
}

bool wr_doc_export(WrDoc *doc, const char *kind, const char *path, WrDocError *error)
{
    ApiCall call;
    FileExport export = { doc, kind, path };
    wr_api_begin(&call, doc);
    return wr_api_end(
        &call, wr_session_for_variants(doc->session, path, export_variant, &export, &call.err),
        error);
}

typedef bool Sink(void *ctx, const void *bytes, size_t count);

/* Most kinds are written and read back as files: solids, drawings and formats of OpenImageIO need a file to seek in. */
static bool export_bytes(WrDoc *doc, const char *kind, const char *name, Sink *write, void *ctx,
                         WrError *err)
{
    WrText path = { 0 };
    char *bytes = NULL;
    size_t length = 0;
    if (!*name || strchr(name, '/'))
        return wr_fail(
            err, "name \"%.80s\": must be a file name without folders, such as \"n.png\"", name);
    const bool good = wr_api_scratch(doc, &path, err) && (wr_text_addf(&path, "/%s", name), true) &&
                      export_file(doc, kind, wr_text_get(&path), err) &&
                      wr_file_read(wr_text_get(&path), SIZE_MAX, &bytes, &length, err) &&
                      (write(ctx, bytes, length) || wr_fail(err, "cancelled"));
    wr_path_remove(wr_text_get(&path));
    wr_free(bytes);
    wr_text_fini(&path);
    return good;
}

bool wr_doc_export_bytes(WrDoc *doc, const char *kind, const char *name,
                         bool (*write)(void *ctx, const void *bytes, size_t count), void *ctx,
                         WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, export_bytes(doc, kind, name, write, ctx, &call.err), error);
}

/* ---- pictures ---- */

static bool render(WrDoc *doc, double turn, const WrDocArray *given, WrError *err)
{
    WrDocArray array;
    WrFrame frame;
    const bool floats = given->type == WR_DOC_F32;
    if (given->type == WR_DOC_U16)
        return wr_fail(err, "render: the array must be of floats or of codes of 8 bits");
    const int channels = !floats && given->channels == 3 ? 3 : 4;
    if (!check_array(given, given->width, given->height, channels, &array, err) ||
        !wr_session_frame(doc->session, array.width, array.height, turn, &frame, err))
        return false;
    const size_t count = (size_t)array.width * (size_t)array.height;
    uint8_t *codes = floats ? NULL : wr_try_alloc_unset(count, (size_t)channels, "a picture", err);
    if (!floats && !codes) return false;
    const WrFrameCodes how = wr_frame_codes_of(wr_session_document(doc->session)->scene, true);
    if (channels == 3) wr_frame_to_srgb8(&frame, &how, false, codes, wr_api_pool(doc));
    else if (!floats) wr_frame_to_alpha8(&frame, &how.tone, codes, wr_api_pool(doc));
    const char *from = floats ? (const char *)frame.rgba : (const char *)codes;
    const size_t row = (size_t)array.width * (size_t)channels * type_bytes[array.type];
    for (int y = 0; y < array.height; y++) put_row(&array, y, from + (size_t)y * row);
    wr_free(codes);
    return true;
}

bool wr_doc_render(WrDoc *doc, double turn, const WrDocArray *array, WrDocError *error)
{
    ApiCall call;
    wr_api_begin(&call, doc);
    return wr_api_end(&call, render(doc, turn, array, &call.err), error);
}
