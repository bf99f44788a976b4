/* Parts of an OpenRaster file: entries of the zip archive, its output file, and stack.xml. */
#include "document/ora_stack.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "system/fd.h"

#include <errno.h>
#include <expat.h>
#include <math.h>
#include <string.h>
#include <zip.h>

/* ---- the zip archive ---- */

#define ENTRIES_MAX 10000
#define PIECE ((zip_uint64_t)1 << 20)  /* bytes between two checks for cancellation */
#define TOTAL_MAX ((uint64_t)16 << 30) /* maximum bytes that are read from an archive in total */
#define RATIO_MAX 200
#define RATIO_FREE ((uint64_t)1 << 20) /* entries up to this many bytes may have any ratio */

struct WrOraZip {
    zip_t *archive;
    char *path;
    uint64_t total;
};

WrOraZip *wr_ora_zip_open(const char *path, WrError *err)
{
    int fd = wr_file_open(path, WR_FILE_MAX, NULL, err);
    return fd < 0 ? NULL : wr_ora_zip_take(path, fd, err);
}

WrOraZip *wr_ora_zip_take(const char *path, int fd, WrError *err)
{
    int trouble = 0;
    zip_t *archive = zip_fdopen(fd, 0, &trouble);
    if (!archive) {
        wr_fail(err, "%s: is not an OpenRaster file, truncated or damaged", path);
        wr_fd_close(fd);
        return NULL;
    }
    zip_int64_t entries = zip_get_num_entries(archive, 0);
    if (entries > ENTRIES_MAX) {
        wr_fail(err, "%s: holds %lld files; %d is the limit", path, (long long)entries,
                ENTRIES_MAX);
        zip_discard(archive);
        return NULL;
    }
    WrOraZip *zip = wr_alloc(1, sizeof *zip);
    *zip = (WrOraZip){ archive, wr_strdup(path), 0 };
    return zip;
}

void wr_ora_zip_close(WrOraZip *zip)
{
    if (!zip) return;
    zip_discard(zip->archive);
    wr_free(zip->path);
    wr_free(zip);
}

static bool check_entry(WrOraZip *zip, const char *name, size_t most, const zip_stat_t *is,
                        WrError *err)
{
    const zip_uint64_t needed =
        ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
    if ((is->valid & needed) != needed)
        return wr_fail(err, "%s: damaged: %.80s in it is unknown", zip->path, name);
    if (is->encryption_method != ZIP_EM_NONE)
        return wr_fail(err, "%s: %.80s in it is encrypted", zip->path, name);
    if (is->comp_method != ZIP_CM_STORE && is->comp_method != ZIP_CM_DEFLATE)
        return wr_fail(err,
                       "%s: %.80s in it is compressed by method %d; must be stored or deflated",
                       zip->path, name, is->comp_method);
    if (is->size > most)
        return wr_fail(err, "%s: %.80s in it has %.1f MB; %.1f MB is the limit", zip->path, name,
                       (double)is->size / 1e6, (double)most / 1e6);
    if (is->size > RATIO_FREE && is->size / RATIO_MAX > is->comp_size)
        return wr_fail(err, "%s: %.80s in it unpacks from %llu bytes to %.1f MB: hostile",
                       zip->path, name, (unsigned long long)is->comp_size, (double)is->size / 1e6);
    if (is->size > TOTAL_MAX - zip->total)
        return wr_fail(err, "%s: its files have more than %.0f MB in all", zip->path,
                       (double)TOTAL_MAX / 1e6);
    return true;
}

bool wr_ora_zip_read(WrOraZip *zip, const char *name, size_t most, char **bytes, size_t *length,
                     WrError *err)
{
    zip_stat_t is;
    zip_int64_t index = zip_name_locate(zip->archive, name, 0);
    if (index < 0 || zip_stat_index(zip->archive, (zip_uint64_t)index, 0, &is) != 0)
        return wr_fail(err, "%s: damaged: has no %.80s in it", zip->path, name);
    if (!check_entry(zip, name, most, &is, err)) return false;
    zip->total += is.size;
    char *block = wr_try_alloc((size_t)is.size + 1, 1, zip->path, err);
    if (!block) return false;
    zip_file_t *file = zip_fopen_index(zip->archive, (zip_uint64_t)index, 0);
    size_t have = 0;
    zip_int64_t n = file ? 1 : -1;
    while (n > 0 && have < is.size && !wr_progress_stopped()) {
        n = zip_fread(file, block + have, is.size - have < PIECE ? is.size - have : PIECE);
        if (n > 0) have += (size_t)n;
    }
    char beyond; /* the library verifies the checksum when the end is read */
    if (n > 0 || (n == 0 && is.size == 0)) n = zip_fread(file, &beyond, 1);
    if (file) zip_fclose(file);
    if (n != 0 || have != is.size) {
        wr_free(block);
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
        return wr_fail(err, "%s: %.80s in it is truncated or damaged", zip->path, name);
    }
    *bytes = block;
    *length = have;
    return true;
}

/* ---- the output file ---- */

/* Output file of an archive. The library itself would create a temporary file beside it, which remains if the
   program is killed. */

static zip_int64_t answer_error(const WrOraSink *sink, void *data, zip_uint64_t length)
{
    int codes[2] = { ZIP_ER_WRITE, sink->error };
    if (length < sizeof codes) return -1;
    memcpy(data, codes, sizeof codes);
    return sizeof codes;
}

static zip_int64_t answer_stat(void *data, zip_uint64_t length)
{
    zip_stat_t *report = data;
    if (length < sizeof *report) return -1;
    zip_stat_init(report);
    report->size = 0;
    report->valid = ZIP_STAT_SIZE;
    return sizeof *report;
}

static zip_int64_t write_bytes(WrOraSink *sink, const char *bytes, zip_uint64_t length)
{
    if (!sink->error && !sink->to.write(sink->to.to, bytes, (size_t)length, sink->at))
        sink->error = errno;
    if (sink->error) return -1;
    sink->at += (int64_t)length;
    if (sink->at > sink->end) sink->end = sink->at;
    return (zip_int64_t)length;
}

static zip_int64_t move_to(WrOraSink *sink, void *data, zip_uint64_t length)
{
    zip_error_t error;
    zip_error_init(&error);
    zip_int64_t at = zip_source_seek_compute_offset((zip_uint64_t)sink->at, (zip_uint64_t)sink->end,
                                                    data, length, &error);
    zip_error_fini(&error);
    if (at < 0) return -1;
    sink->at = at;
    return 0;
}

static zip_int64_t on_sink(void *ctx, void *data, zip_uint64_t length, zip_source_cmd_t command)
{
    WrOraSink *sink = ctx;
    switch (command) {
    case ZIP_SOURCE_SUPPORTS:
        return zip_source_make_command_bitmap(
            ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE, ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR,
            ZIP_SOURCE_FREE, ZIP_SOURCE_SEEK, ZIP_SOURCE_TELL, ZIP_SOURCE_BEGIN_WRITE,
            ZIP_SOURCE_COMMIT_WRITE, ZIP_SOURCE_ROLLBACK_WRITE, ZIP_SOURCE_WRITE,
            ZIP_SOURCE_SEEK_WRITE, ZIP_SOURCE_TELL_WRITE, ZIP_SOURCE_REMOVE, -1);
    case ZIP_SOURCE_ERROR: return answer_error(sink, data, length);
    case ZIP_SOURCE_STAT: return answer_stat(data, length);
    case ZIP_SOURCE_WRITE: return write_bytes(sink, data, length);
    case ZIP_SOURCE_SEEK_WRITE: return move_to(sink, data, length);
    case ZIP_SOURCE_TELL_WRITE: return sink->at;
    case ZIP_SOURCE_COMMIT_WRITE: return sink->error ? -1 : 0;
    default: return 0;
    }
}

zip_t *wr_ora_sink_open(WrOraSink *sink, WrError *err)
{
    zip_error_t trouble;
    zip_error_init(&trouble);
    zip_source_t *source = zip_source_function_create(on_sink, sink, &trouble);
    zip_t *archive =
        source ? zip_open_from_source(source, ZIP_CREATE | ZIP_TRUNCATE, &trouble) : NULL;
    if (!archive) wr_fail(err, "%s", zip_error_strerror(&trouble));
    if (!archive && source) zip_source_free(source);
    zip_error_fini(&trouble);
    return archive;
}

/* ---- stack.xml ---- */

#define DEPTH_MAX (WR_DEPTH_MAX + 1) /* with the element of all layers */
#define ELEMENTS_MAX 128             /* nested elements of any kind */
#define OURS WR_ORA_NAMESPACE "|"

/* ---- blend modes ---- */

const char *wr_ora_operation(WrBlend blend)
{
    WR_ROWS(operations);
    static const char *const operations[WR_BLEND_COUNT] = {
        [WR_ROW(WR_BLEND_ADD)] = "svg:plus",
        [WR_ROW(WR_BLEND_SUBTRACT)] = "svg:difference",
        [WR_ROW(WR_BLEND_MAX)] = "svg:lighten",
        [WR_ROW(WR_BLEND_MIN)] = "svg:darken",
        [WR_ROW(WR_BLEND_SMOOTH_MAX)] = "svg:lighten",
        [WR_ROW(WR_BLEND_SMOOTH_MIN)] = "svg:darken",
        [WR_ROW(WR_BLEND_REPLACE)] = "svg:src-over",
        [WR_ROW(WR_BLEND_MIX)] = "svg:src-over",
        [WR_ROW(WR_BLEND_MULTIPLY)] = "svg:multiply",
    };
    WR_ROWS_END(operations, WR_BLEND_COUNT);
    return operations[blend];
}

WrBlend wr_ora_blend(const char *operation, bool *exact)
{
    static const struct {
        const char *operation;
        WrBlend blend;
    } known[] = {
        { "svg:src-over", WR_BLEND_REPLACE },
        { "svg:plus", WR_BLEND_ADD },
        { "svg:lighten", WR_BLEND_MAX },
        { "svg:darken", WR_BLEND_MIN },
        { "svg:multiply", WR_BLEND_MULTIPLY },
        /* Equal if the layer is not above the composite below it. */
        { "svg:difference", WR_BLEND_SUBTRACT },
    };
    for (size_t i = 0; operation && i < sizeof known / sizeof *known; i++) {
        *exact = known[i].blend != WR_BLEND_SUBTRACT;
        if (strcmp(operation, known[i].operation) == 0) return known[i].blend;
    }
    *exact = operation == NULL; /* the format's default */
    return WR_BLEND_REPLACE;
}

/* ---- writing ---- */

/* Bytes of a valid UTF-8 sequence that XML 1.0 can represent, else 0. */
static size_t whole_character(const unsigned char *at)
{
    static const unsigned least[5] = { 0, 0, 0x80, 0x800, 0x10000 };
    size_t length = at[0] < 0x80 ? 1 : at[0] < 0xC0 ? 0 : at[0] < 0xE0 ? 2 : at[0] < 0xF0 ? 3 : 4;
    if (length == 0 || at[0] > 0xF4) return 0;
    unsigned code = length == 1 ? at[0] : at[0] & (0xFFU >> (length + 1));
    for (size_t i = 1; i < length; i++) {
        if ((at[i] & 0xC0) != 0x80) return 0;
        code = code << 6 | (at[i] & 0x3FU);
    }
    bool good = code >= 0x20 ? code != 0xFFFE && code != 0xFFFF && (code & ~0x7FFU) != 0xD800 &&
                                   code <= 0x10FFFF
                             : code == '\t' || code == '\n' || code == '\r';
    return good && code >= least[length] ? length : 0;
}

bool wr_ora_add_attribute(WrText *xml, const char *name, const char *value)
{
    bool whole = true;
    wr_text_addf(xml, " %s=\"", name);
    for (const char *at = value; *at;) {
        size_t length = whole_character((const unsigned char *)at);
        if (length == 0) {
            wr_text_add(xml, "?");
            whole = false;
            at++;
            continue;
        }
        if (strchr("&<>\"\t\n\r", *at)) wr_text_addf(xml, "&#%d;", *at);
        else wr_text_add_n(xml, at, length);
        at += length;
    }
    wr_text_add(xml, "\"");
    return whole;
}

/* ---- reading ---- */

/* Where the top left pixel of a group is. */
typedef struct Offset {
    int x, y;
} Offset;

typedef struct Reading {
    WrOraStack *stack;
    XML_Parser parser;
    Offset groups[DEPTH_MAX];
    int depth;   /* number of open groups; the root stack counts as one */
    int element; /* nesting depth of elements of any kind */
    int skip;    /* depth at which an unknown element began, or 0 */
    WrError err; /* reason for stopping the parser; "" */
} Reading;

static void stop(Reading *reading, const char *why)
{
    if (!reading->err.text[0]) wr_fail(&reading->err, "%s", why);
    XML_StopParser(reading->parser, XML_FALSE);
}

static const char *find(const char **attributes, const char *name)
{
    for (; attributes[0]; attributes += 2)
        if (strcmp(attributes[0], name) == 0) return attributes[1];
    return NULL;
}

static double number(Reading *reading, const char **attributes, const char *name, double otherwise,
                     double low, double high)
{
    const char *text = find(attributes, name);
    double value = otherwise;
    if (!text) return otherwise;
    if (wr_number_parse(text, strlen(text), &value) && value >= low && value <= high) return value;
    char why[160];
    snprintf(why, sizeof why, "damaged: %s is '%.40s' in its list of layers", name, text);
    stop(reading, why);
    return otherwise;
}

static bool is(const char *text, const char *word)
{
    return text && strcmp(text, word) == 0;
}

/* Offset of a group or layer, added to that of its group. */
static Offset read_offset(Reading *reading, const char **attributes)
{
    Offset outer = { 0, 0 };
    if (reading->depth > 0) outer = reading->groups[reading->depth - 1];
    double limit = 1e6; /* sums of a few are far inside int */
    return (Offset){ outer.x + (int)number(reading, attributes, "x", 0.0, -limit, limit),
                     outer.y + (int)number(reading, attributes, "y", 0.0, -limit, limit) };
}

static void add_layer(Reading *reading, const char **attributes, bool group)
{
    /* the composite of all the others, for other programs */
    if (is(find(attributes, OURS "composite"), "on")) return;
    if (reading->stack->layers.count >= WR_LAYERS_MAX) {
        char why[64];
        snprintf(why, sizeof why, "has more than %d layers", WR_LAYERS_MAX);
        stop(reading, why);
        return;
    }
    const Offset at = read_offset(reading, attributes);
    WrOraLayer layer = { .x = at.x,
                         .y = at.y,
                         .opacity = number(reading, attributes, "opacity", 1.0, 0.0, 1.0),
                         .visible = !is(find(attributes, "visibility"), "hidden"),
                         .locked = is(find(attributes, "edit-locked"), "true"),
                         .on_mask = is(find(attributes, OURS "on-mask"), "on"),
                         .selected = is(find(attributes, "selected"), "true"),
                         .depth = reading->depth - 1,
                         .is_group = group,
                         .collapsed = group && is(find(attributes, OURS "collapsed"), "on"),
                         .passes = group && !is(find(attributes, "isolation"), "isolate"),
                         .name = wr_strdup(find(attributes, "name")),
                         .src = wr_strdup(find(attributes, "src")),
                         .operation = wr_strdup(find(attributes, "composite-op")),
                         .heights = wr_strdup(find(attributes, OURS "heights")),
                         .cover = wr_strdup(find(attributes, OURS "cover")),
                         .mask = wr_strdup(find(attributes, OURS "mask")),
                         .blend = wr_strdup(find(attributes, OURS "blend")),
                         .radius = wr_strdup(find(attributes, OURS "radius")),
                         .filter = wr_strdup(find(attributes, OURS "filter")),
                         .line = wr_strdup(find(attributes, OURS "line")),
                         .below = wr_strdup(find(attributes, OURS "below")),
                         .mask_line = wr_strdup(find(attributes, OURS "mask-line")),
                         .mask_read = wr_strdup(find(attributes, OURS "mask-read")),
                         .values = wr_strdup(find(attributes, OURS "values")),
                         .name_bytes = wr_strdup(find(attributes, OURS "name")),
                         .own_opacity = wr_strdup(find(attributes, OURS "opacity")),
                         .own_visible = wr_strdup(find(attributes, OURS "visible")) };
    wr_array_push(&reading->stack->layers, layer);
}

static void begin_group(Reading *reading, const char **attributes)
{
    if (reading->depth >= DEPTH_MAX) {
        char why[64];
        snprintf(why, sizeof why, "its groups are nested more than %d deep", WR_DEPTH_MAX);
        stop(reading, why);
        return;
    }
    const Offset offset = read_offset(reading, attributes);
    if (reading->depth > 0) add_layer(reading, attributes, true);
    reading->groups[reading->depth++] = offset;
}

int wr_ora_version(const WrDocument *document, bool composite)
{
    const WrScene *scene = document->scene;
    const bool new =
        wr_object_any_picture(scene, WR_OBJECT_NORMALS) || wr_scene_several_meshes(scene);
    const WrSceneAge age = wr_scene_age(scene);
    if (age == WR_SCENE_OF_VIEW) return WR_ORA_VERSION;
    if (wr_document_groups(document) || document->variants) return WR_ORA_VERSION_GROUPS;
    if (wr_document_generates(document)) return WR_ORA_VERSION_GENERATORS;
    if (age == WR_SCENE_OF_PROJECTION) return WR_ORA_VERSION_PROJECTION;
    if (composite) return WR_ORA_VERSION_COMPOSITE;
    if (wr_document_filters(document)) return WR_ORA_VERSION_FILTERS;
    if (age == WR_SCENE_OF_FACETS) return WR_ORA_VERSION_FACETS;
    if (age == WR_SCENE_OF_CELL) return WR_ORA_VERSION_CELL;
    return new ? WR_ORA_VERSION_OBJECTS : WR_ORA_VERSION_PLAIN;
}

const char *wr_ora_picture_name(const char *prefix, int object, int which, const char *suffix,
                                char buffer[WR_ORA_PICTURE_NAME])
{
    const char *part = wr_object_pictures[which].part;
    if (object == 0) snprintf(buffer, WR_ORA_PICTURE_NAME, "%s%s%s", prefix, part, suffix);
    else snprintf(buffer, WR_ORA_PICTURE_NAME, "%s%s-%d%s", prefix, part, object + 1, suffix);
    return buffer;
}

static void read_image(Reading *reading, const char **attributes)
{
    WrOraStack *stack = reading->stack;
    stack->width = (int)number(reading, attributes, "w", 0.0, 0.0, 1e9);
    stack->height = (int)number(reading, attributes, "h", 0.0, 0.0, 1e9);
    stack->version = wr_strdup(find(attributes, OURS "version"));
    stack->wrap = wr_strdup(find(attributes, OURS "wrap"));
    stack->active = wr_strdup(find(attributes, OURS "active"));
    stack->solo = wr_strdup(find(attributes, OURS "solo"));
    stack->scene = wr_strdup(find(attributes, OURS "scene"));
    stack->selection = wr_strdup(find(attributes, OURS "selection"));
    for (int i = 0; i < WR_OBJECTS_MAX; i++)
        for (int k = 0; k < WR_OBJECT_PICTURES; k++) {
            char name[WR_ORA_PICTURE_NAME];
            stack->pictures[i][k] =
                wr_strdup(find(attributes, wr_ora_picture_name(OURS, i, k, "", name)));
        }
    stack->mesh = wr_strdup(find(attributes, OURS "mesh"));
    stack->variants = wr_strdup(find(attributes, OURS "variants"));
    stack->variant = wr_strdup(find(attributes, OURS "variant"));
}

/* Some programs use a namespace for the elements, most do not. */
static const char *local(const char *name)
{
    const char *bar = strrchr(name, '|');
    return bar ? bar + 1 : name;
}

static void XMLCALL on_start(void *ctx, const char *name, const char **attributes)
{
    Reading *reading = ctx;
    name = local(name);
    reading->element++;
    if (reading->element > ELEMENTS_MAX) stop(reading, "its list of layers is nested too deep");
    else if (reading->skip) return;
    else if (reading->element == 1 && is(name, "image")) read_image(reading, attributes);
    else if (reading->element == 1)
        stop(reading, "damaged: its list of layers is no list of layers");
    else if (is(name, "stack") && reading->element == reading->depth + 2)
        begin_group(reading, attributes);
    else if (is(name, "layer") && reading->depth > 0 && reading->element == reading->depth + 2)
        add_layer(reading, attributes, false);
    else {
        reading->stack->unknown++;
        reading->skip = reading->element;
    }
}

static void XMLCALL on_end(void *ctx, const char *name)
{
    Reading *reading = ctx;
    if (reading->skip == reading->element) reading->skip = 0;
    else if (!reading->skip && is(local(name), "stack") && reading->depth > 0) reading->depth--;
    reading->element--;
}

/* Entities need a document type: such files are refused, so there is no unbounded expansion. */
static void XMLCALL on_doctype(void *ctx, const char *name, const char *system, const char *public,
                               int internal)
{
    (void)name;
    (void)system;
    (void)public;
    (void)internal;
    stop(ctx, "its list of layers declares a document type, which such files must not");
}

bool wr_ora_stack_read(const char *xml, size_t length, WrOraStack *stack, WrError *err)
{
    *stack = (WrOraStack){ 0 };
    Reading *reading = wr_alloc(1, sizeof *reading);
    reading->stack = stack;
    reading->parser = XML_ParserCreateNS(NULL, '|');
    XML_SetUserData(reading->parser, reading);
    XML_SetElementHandler(reading->parser, on_start, on_end);
    XML_SetStartDoctypeDeclHandler(reading->parser, on_doctype);
    bool good = XML_Parse(reading->parser, xml, (int)length, 1) == XML_STATUS_OK;
    if (reading->err.text[0]) good = wr_fail(err, "%s", wr_error_message(&reading->err));
    else if (!good)
        wr_fail(err, "damaged list of layers, line %lu: %s",
                (unsigned long)XML_GetCurrentLineNumber(reading->parser),
                XML_ErrorString(XML_GetErrorCode(reading->parser)));
    XML_ParserFree(reading->parser);
    wr_free(reading);
    if (!good) wr_ora_stack_fini(stack);
    return good;
}

void wr_ora_stack_fini(WrOraStack *stack)
{
    for (int i = 0; i < stack->layers.count; i++) {
        WrOraLayer *layer = &stack->layers.data[i];
        char *texts[] = { layer->name,        layer->src,         layer->operation,
                          layer->heights,     layer->cover,       layer->mask,
                          layer->blend,       layer->radius,      layer->name_bytes,
                          layer->own_opacity, layer->own_visible, layer->filter,
                          layer->line,        layer->below,       layer->mask_line,
                          layer->mask_read,   layer->values };
        for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) wr_free(texts[k]);
    }
    wr_array_free(&stack->layers);
    char *texts[] = { stack->version,   stack->wrap,     stack->active,
                      stack->solo,      stack->scene,    stack->mesh,
                      stack->selection, stack->variants, stack->variant };
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) wr_free(texts[k]);
    for (int i = 0; i < WR_OBJECTS_MAX; i++)
        for (int k = 0; k < WR_OBJECT_PICTURES; k++) wr_free(stack->pictures[i][k]);
    *stack = (WrOraStack){ 0 };
}

void wr_ora_add_float(WrText *xml, const char *name, float value)
{
    char buffer[WR_NUMBER_SIZE];
    wr_ora_add_attribute(xml, name, wr_number_print_float(value, buffer));
}

void wr_ora_add_name(WrText *xml, const char *name)
{
    if (wr_ora_add_attribute(xml, "name", name)) return;
    wr_text_add(xml, " wrinkle:name=\"");
    for (; *name; name++) wr_text_addf(xml, "%02x", (unsigned)(unsigned char)*name);
    wr_text_add(xml, "\"");
}

void wr_ora_add_filter(WrText *xml, const WrFilter *filter)
{
    WrText text = { 0 };
    if (!filter->op) return;
    wr_filter_print(filter, &text);
    wr_ora_add_attribute(xml, "wrinkle:filter", wr_text_get(&text));
    wr_text_fini(&text);
}
