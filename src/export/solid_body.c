/* Triangles of solids and their files. */
#include "export/solid_body.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"

#include <math.h>
#include <string.h>
#include <zip.h>

/* ---- triangles ---- */

void wr_solid_body_fini(WrSolidBody *body)
{
    wr_free(body->points);
    wr_free(body->triangles);
    wr_free(body->uv);
    *body = (WrSolidBody){ 0 };
}

int32_t wr_solid_body_add_point(WrSolidBody *body, const float at[3])
{
    if (body->point_count == body->point_room) {
        const int32_t room = body->point_room ? 2 * body->point_room : 1024;
        body->points =
            wr_realloc(body->points, (size_t)body->point_room, (size_t)room, sizeof *body->points);
        body->point_room = room;
    }
    memcpy(body->points[body->point_count], at, sizeof *body->points);
    return body->point_count++;
}

void wr_solid_body_add_triangle(WrSolidBody *body, const int32_t corners[3], float uv[3][2])
{
    if (body->triangle_count == body->triangle_room) {
        const int32_t was = body->triangle_room, room = was ? 2 * was : 1024;
        body->triangles =
            wr_realloc(body->triangles, (size_t)was, (size_t)room, sizeof *body->triangles);
        body->uv = wr_realloc(body->uv, (size_t)was, (size_t)room, sizeof *body->uv);
        body->triangle_room = room;
    }
    memcpy(body->triangles[body->triangle_count], corners, sizeof *body->triangles);
    memcpy(body->uv[body->triangle_count++], uv, sizeof *body->uv);
}

WrVec3 wr_solid_body_point(const WrSolidBody *body, int32_t i)
{
    return (WrVec3){ body->points[i][0], body->points[i][1], body->points[i][2] };
}

WrVec3 wr_solid_body_area(const WrSolidBody *body, int32_t a, int32_t b, int32_t c)
{
    const WrVec3 p = wr_solid_body_point(body, a);
    return v3_cross(v3_sub(wr_solid_body_point(body, b), p),
                    v3_sub(wr_solid_body_point(body, c), p));
}

double wr_solid_body_volume(const WrSolidBody *body)
{
    double sum = 0.0;
    for (int32_t i = 0; i < body->triangle_count; i++) {
        const int32_t *t = body->triangles[i];
        sum += v3_dot(wr_solid_body_point(body, t[0]),
                      v3_cross(wr_solid_body_point(body, t[1]), wr_solid_body_point(body, t[2])));
    }
    return sum / 6.0;
}

void wr_solid_body_reverse(WrSolidBody *body)
{
    for (int32_t i = 0; i < body->triangle_count; i++) {
        const int32_t a = body->triangles[i][0];
        body->triangles[i][0] = body->triangles[i][1];
        body->triangles[i][1] = a;
        float uv[2];
        memcpy(uv, body->uv[i][0], sizeof uv);
        memcpy(body->uv[i][0], body->uv[i][1], sizeof uv);
        memcpy(body->uv[i][1], uv, sizeof uv);
    }
}

void wr_solid_body_bounds(const WrSolidBody *body, WrVec3 *low, WrVec3 *high)
{
    *low = (WrVec3){ INFINITY, INFINITY, INFINITY };
    *high = (WrVec3){ -INFINITY, -INFINITY, -INFINITY };
    for (int32_t i = 0; i < body->point_count; i++) {
        const WrVec3 p = wr_solid_body_point(body, i);
        *low = (WrVec3){ fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z) };
        *high = (WrVec3){ fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z) };
    }
}

/* ---- file ---- */

#define WORDS "Wrinkle, lengths in millimetres"
#define BLOCK ((size_t)1 << 20) /* bytes written at once */
#define LINE 256                /* maximum bytes of one entry */

/* Output buffer of the file. */
typedef struct Out {
    WrFileTarget target;
    WrText bytes;
    int64_t done, all; /* progress, in entries */
} Out;

static bool flush(Out *out, WrError *err)
{
    if (!wr_progress_report((double)out->done / (double)out->all)) return wr_fail(err, "cancelled");
    const bool good = wr_file_put(&out->target, out->bytes.data, out->bytes.length, err);
    wr_text_clear(&out->bytes);
    return good;
}

/* Counts a complete entry. */
static bool entry(Out *out, WrError *err)
{
    out->done++;
    return out->bytes.length + LINE < BLOCK || flush(out, err);
}

/* All binary formats here are little endian; bytes are shifted out, so that the host's order has no influence. */
static void add_u32(Out *out, uint32_t x)
{
    const char bytes[4] = { (char)(x & 255), (char)(x >> 8 & 255), (char)(x >> 16 & 255),
                            (char)(x >> 24) };
    wr_text_add_n(&out->bytes, bytes, 4);
}

static void add_float(Out *out, float x)
{
    uint32_t bits;
    memcpy(&bits, &x, 4);
    add_u32(out, bits);
}

static void add_place(Out *out, const float at[3])
{
    for (int k = 0; k < 3; k++) add_float(out, at[k]);
}

/* ---- STL ---- */

static WrVec3 normal_of(const WrSolidBody *body, const int32_t *t)
{
    return v3_unit(wr_solid_body_area(body, t[0], t[1], t[2]), (WrVec3){ 0, 0, 1 });
}

/* Binary STL: 80 bytes of header (must not start with "solid", the mark of the text form), a uint32 count, then 50 bytes per
   triangle: normal and three corners as float32, two attribute bytes that are 0. STL has no shared points and no (u,v). */
static bool write_stl(const WrSolidBody *body, Out *out, WrError *err)
{
    char head[80] = WORDS;
    wr_text_add_n(&out->bytes, head, sizeof head);
    add_u32(out, (uint32_t)body->triangle_count);
    bool good = true;
    for (int32_t i = 0; i < body->triangle_count && good; i++) {
        const int32_t *t = body->triangles[i];
        const WrVec3 n = normal_of(body, t);
        add_place(out, (const float[3]){ (float)n.x, (float)n.y, (float)n.z });
        for (int k = 0; k < 3; k++) add_place(out, body->points[t[k]]);
        wr_text_add_n(&out->bytes, "\0", 2);
        good = entry(out, err);
    }
    return good;
}

/* ---- PLY ---- */

/* Binary PLY: a text header, then float32 x y z per point, then per face a uchar 3 with three int32 numbers, and a uchar 6
   with u v of the three corners: texture coordinates per corner (MeshLab's `texcoord`), since a seam's points have two. */
static bool write_ply(const WrSolidBody *body, Out *out, WrError *err)
{
    wr_text_addf(&out->bytes,
                 "ply\nformat binary_little_endian 1.0\ncomment " WORDS "\nelement vertex %d\n"
                 "property float x\nproperty float y\nproperty float z\nelement face %d\n"
                 "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
                 "end_header\n",
                 body->point_count, body->triangle_count);
    bool good = true;
    for (int32_t i = 0; i < body->point_count && good; i++) {
        add_place(out, body->points[i]);
        good = entry(out, err);
    }
    for (int32_t i = 0; i < body->triangle_count && good; i++) {
        wr_text_add_n(&out->bytes, "\3", 1);
        for (int k = 0; k < 3; k++) add_u32(out, (uint32_t)body->triangles[i][k]);
        wr_text_add_n(&out->bytes, "\6", 1);
        for (int k = 0; k < 6; k++) add_float(out, body->uv[i][k / 2][k % 2]);
        good = entry(out, err);
    }
    return good;
}

/* ---- OBJ ---- */

static void add_numbers(Out *out, const char *word, int count, const float *x)
{
    char number[WR_NUMBER_SIZE];
    wr_text_add(&out->bytes, word);
    for (int k = 0; k < count; k++) {
        wr_text_add(&out->bytes, " ");
        wr_text_add(&out->bytes, wr_number_print_float(x[k], number));
    }
    wr_text_add(&out->bytes, "\n");
}

/* A `vt` line is written when a corner's (u,v) differ from those that its point had last.
   * first: [2][points]: the corner with those, 3 times its triangle and its number, -1: none; then the number of their line.
   Numbers of v and vt start at 1 in OBJ. */
static bool write_obj_faces(const WrSolidBody *body, int32_t *first, Out *out, WrError *err)
{
    int32_t count = 0;
    bool good = true;
    for (int32_t i = 0; i < body->triangle_count && good; i++) {
        const int32_t *t = body->triangles[i];
        int32_t vt[3];
        for (int k = 0; k < 3; k++) {
            const int32_t was = first[t[k]];
            if (was >= 0 &&
                memcmp(body->uv[was / 3][was % 3], body->uv[i][k], sizeof body->uv[i][k]) == 0) {
                vt[k] = first[body->point_count + t[k]];
                continue;
            }
            add_numbers(out, "vt", 2, body->uv[i][k]);
            vt[k] = ++count;
            first[t[k]] = 3 * i + k;
            first[body->point_count + t[k]] = count;
        }
        wr_text_addf(&out->bytes, "f %d/%d %d/%d %d/%d\n", t[0] + 1, vt[0], t[1] + 1, vt[1],
                     t[2] + 1, vt[2]);
        good = entry(out, err);
    }
    return good;
}

static bool write_obj(const WrSolidBody *body, Out *out, WrError *err)
{
    const size_t points = (size_t)body->point_count;
    int32_t *first = wr_try_alloc(2 * points, sizeof *first, "a solid", err);
    bool good = first;
    wr_text_add(&out->bytes, "# " WORDS "\no relief\n");
    for (int32_t i = 0; i < body->point_count && good; i++) {
        first[i] = -1;
        add_numbers(out, "v", 3, body->points[i]);
        good = entry(out, err);
    }
    good = good && write_obj_faces(body, first, out, err);
    wr_free(first);
    return good;
}

/* ---- 3MF ---- */

/* 3MF (core specification 1.3): a zip archive with three entries: content types, a relation that names the
   model, and the model in XML with its unit. Entries have a fixed date, so that equal solids are equal files. */

static const char content_types[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" "
    "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>\n";

static const char relations[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

static void add_attribute(WrText *xml, const char *name, double value)
{
    char number[WR_NUMBER_SIZE];
    wr_text_add(xml, name);
    wr_text_add(xml, wr_number_print_float((float)value, number));
    wr_text_add(xml, "\"");
}

static void add_index(WrText *xml, const char *name, int32_t index)
{
    char digits[12];
    int at = sizeof digits;
    do digits[--at] = (char)('0' + index % 10);
    while ((index /= 10) > 0);
    wr_text_add(xml, name);
    wr_text_add_n(xml, digits + at, sizeof digits - (size_t)at);
    wr_text_add(xml, "\"");
}

static bool report_entry(Out *out, WrError *err)
{
    return ++out->done % 65536 != 0 || wr_progress_report((double)out->done / (double)out->all) ||
           wr_fail(err, "cancelled");
}

static bool add_model(const WrSolidBody *body, Out *out, WrText *xml, WrError *err)
{
    bool good = true;
    wr_text_add(xml,
                "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" "
                "xml:lang=\"en-US\" "
                "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
                "<metadata name=\"Application\">Wrinkle</metadata>\n<resources><object id=\"1\" "
                "type=\"model\"><mesh>\n<vertices>\n");
    for (int32_t i = 0; i < body->point_count && good; i++) {
        add_attribute(xml, "<vertex x=\"", (double)body->points[i][0]);
        add_attribute(xml, " y=\"", (double)body->points[i][1]);
        add_attribute(xml, " z=\"", (double)body->points[i][2]);
        wr_text_add(xml, "/>\n");
        good = report_entry(out, err);
    }
    wr_text_add(xml, "</vertices>\n<triangles>\n");
    for (int32_t i = 0; i < body->triangle_count && good; i++) {
        add_index(xml, "<triangle v1=\"", body->triangles[i][0]);
        add_index(xml, " v2=\"", body->triangles[i][1]);
        add_index(xml, " v3=\"", body->triangles[i][2]);
        wr_text_add(xml, "/>\n");
        good = report_entry(out, err);
    }
    wr_text_add(xml, "</triangles>\n</mesh></object></resources>\n"
                     "<build><item objectid=\"1\"/></build>\n</model>\n");
    return good;
}

static bool add_file(zip_t *archive, const char *name, const char *bytes, size_t length)
{
    zip_source_t *source = zip_source_buffer(archive, bytes, length, 0);
    const zip_int64_t index = source ? zip_file_add(archive, name, source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0 && source) zip_source_free(source);
    return index >= 0 && /* level 1: twice as fast, 5 % larger */
           zip_set_file_compression(archive, (zip_uint64_t)index, ZIP_CM_DEFLATE, 1) == 0 &&
           zip_file_set_dostime(archive, (zip_uint64_t)index, 0, 0x21, 0) == 0;
}

static bool copy_source(zip_source_t *source, Out *out, WrError *err)
{
    if (zip_source_open(source) != 0)
        return wr_fail(err, "%s", zip_error_strerror(zip_source_error(source)));
    char *block = wr_alloc_unset(BLOCK, 1);
    zip_int64_t got;
    bool good = true;
    while (good && (got = zip_source_read(source, block, BLOCK)) > 0)
        good = wr_file_put(&out->target, block, (size_t)got, err);
    wr_free(block);
    zip_source_close(source);
    return good;
}

static bool add_archive(const WrText *xml, Out *out, WrError *err)
{
    zip_error_t trouble;
    zip_error_init(&trouble);
    zip_source_t *memory = zip_source_buffer_create(NULL, 0, 0, &trouble);
    zip_t *archive = memory ? zip_open_from_source(memory, ZIP_TRUNCATE, &trouble) : NULL;
    if (!archive) {
        wr_fail(err, "%s", zip_error_strerror(&trouble));
        if (memory) zip_source_free(memory);
        zip_error_fini(&trouble);
        return false;
    }
    zip_error_fini(&trouble);
    zip_source_keep(memory); /* closing the archive frees one reference */
    bool good = add_file(archive, "[Content_Types].xml", content_types, sizeof content_types - 1) &&
                add_file(archive, "_rels/.rels", relations, sizeof relations - 1) &&
                add_file(archive, "3D/3dmodel.model", xml->data, xml->length) &&
                zip_close(archive) == 0;
    if (!good) {
        wr_fail(err, "%s", zip_strerror(archive));
        zip_discard(archive);
    }
    good = good && copy_source(memory, out, err);
    zip_source_free(memory);
    return good;
}

static bool write_3mf(const WrSolidBody *body, Out *out, WrError *err)
{
    WrText xml = { 0 };
    const bool good = add_model(body, out, &xml, err) && add_archive(&xml, out, err);
    wr_text_fini(&xml);
    return good;
}

/* ---- the file ---- */

typedef bool Write(const WrSolidBody *body, Out *out, WrError *err);

static const struct {
    const char *ending;
    Write *write;
} formats[] = {
    { "stl", write_stl }, { "ply", write_ply }, { "obj", write_obj }, { "3mf", write_3mf }
};

static Write *format_of(const char *ending)
{
    for (int i = 0; i < WR_LENGTH(formats); i++)
        if (strcmp(ending, formats[i].ending) == 0) return formats[i].write;
    return NULL;
}

bool wr_solid_body_write(const WrSolidBody *body, const char *ending, const char *path,
                         WrError *err)
{
    Out out = { .all = (int64_t)body->point_count + body->triangle_count };
    Write *write = format_of(ending);
    if (!write) return wr_fail(err, "%s: .%s is not a format for solids", path, ending);
    if (!wr_file_begin(&out.target, path, err)) return false;
    bool good = write(body, &out, err) && flush(&out, err);
    wr_text_fini(&out.bytes);
    if (!good) {
        wr_file_abort(&out.target);
        return false;
    }
    return wr_file_commit(&out.target, err);
}
