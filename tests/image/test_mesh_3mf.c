/* 3MF files: zip archives with a model in XML, written here by hand; whole, damaged and malicious ones. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/mesh.h"

#include <stdlib.h>
#include <zlib.h>

/* ---- a writer of archives ---- */

static void put(WrText *zip, uint32_t value, int size)
{
    for (int i = 0; i < size; i++) {
        const char byte = (char)(value >> 8 * i & 255);
        wr_text_add_n(zip, &byte, 1);
    }
}

typedef struct Entry {
    const char *name, *text;
    bool packed;
    uint32_t claim; /* size in the directory; 0: the true one */
} Entry;

typedef struct Placed {
    uint32_t at, crc, size, packed;
} Placed;

static void put_sizes(WrText *zip, const Entry *entry, const Placed *p)
{
    put(zip, 20, 2);
    put(zip, 0, 2);
    put(zip, entry->packed ? 8 : 0, 2);
    put(zip, 0, 4);
    put(zip, p->crc, 4);
    put(zip, p->packed, 4);
    put(zip, entry->claim ? entry->claim : p->size, 4);
    put(zip, (uint32_t)strlen(entry->name), 2);
    put(zip, 0, 2);
}

static void archive(const Entry *entry, int count, WrText *zip)
{
    Placed placed[8];
    for (int i = 0; i < count; i++) {
        const size_t size = strlen(entry[i].text);
        char *packed = wr_alloc(2 * size + 64, 1);
        z_stream stream = { .next_in = (unsigned char *)entry[i].text,
                            .avail_in = (uInt)size,
                            .next_out = (unsigned char *)packed,
                            .avail_out = (uInt)(2 * size + 64) };
        assert_int_equal(deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, 0), Z_OK);
        assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
        placed[i] = (Placed){ (uint32_t)zip->length,
                              (uint32_t)crc32(0, (const unsigned char *)entry[i].text, (uInt)size),
                              (uint32_t)size,
                              entry[i].packed ? (uint32_t)stream.total_out : (uint32_t)size };
        deflateEnd(&stream);
        wr_text_add_n(zip, "PK\3\4", 4);
        put_sizes(zip, &entry[i], &placed[i]);
        wr_text_add(zip, entry[i].name);
        wr_text_add_n(zip, entry[i].packed ? packed : entry[i].text, placed[i].packed);
        wr_free(packed);
    }
    const uint32_t from = (uint32_t)zip->length;
    for (int i = 0; i < count; i++) {
        wr_text_add_n(zip, "PK\1\2", 4);
        put(zip, 20, 2);
        put_sizes(zip, &entry[i], &placed[i]);
        for (int k = 0; k < 3; k++) put(zip, 0, 2);
        put(zip, 0, 4);
        put(zip, placed[i].at, 4);
        wr_text_add(zip, entry[i].name);
    }
    const uint32_t size = (uint32_t)zip->length - from;
    wr_text_add_n(zip, "PK\5\6", 4);
    put(zip, 0, 4);
    put(zip, (uint32_t)count, 2);
    put(zip, (uint32_t)count, 2);
    put(zip, size, 4);
    put(zip, from, 4);
    put(zip, 0, 2);
}

/* ---- models ---- */

#define CORE "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
static const char types[] =
    "<?xml version=\"1.0\"?><Types "
    "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"><Default "
    "Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>";
static const char relations[] =
    "<?xml version=\"1.0\"?><Relationships "
    "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
    "Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

/* A box of 2 x 3 x 4, moved by the item of the build; `last` is the last corner of its triangles. */
static void box_model(const char *unit, int last, const char *object, WrText *text)
{
    static const int t[12][3] = { { 0, 2, 1 }, { 0, 3, 2 }, { 4, 5, 6 }, { 4, 6, 7 },
                                  { 0, 1, 5 }, { 0, 5, 4 }, { 1, 2, 6 }, { 1, 6, 5 },
                                  { 2, 3, 7 }, { 2, 7, 6 }, { 3, 0, 4 }, { 3, 4, 7 } };
    wr_text_addf(text,
                 "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model%s xmlns=\"" CORE
                 "\"><resources><object id=\"1\" type=\"model\"><mesh><vertices>",
                 unit);
    for (int i = 0; i < 8; i++)
        wr_text_addf(text, "<vertex x=\"%d\" y=\"%d\" z=\"%d\"/>", (i & 3) % 3 ? 2 : 0,
                     i & 2 ? 3 : 0, i & 4);
    wr_text_add(text, "</vertices><triangles>");
    for (int i = 0; i < 12; i++)
        wr_text_addf(text, "<triangle v1=\"%d\" v2=\"%d\" v3=\"%d\"/>", t[i][0], t[i][1],
                     i == 11 ? last : t[i][2]);
    wr_text_addf(text,
                 "</triangles></mesh></object>%s</resources><build><item objectid=\"1\" "
                 "transform=\"1 0 0 0 1 0 0 0 1 100 0 0\"/></build></model>",
                 object);
}

static void file_of(const char *model, bool packed, uint32_t claim, WrText *zip)
{
    const Entry entries[] = { { "[Content_Types].xml", types, packed, 0 },
                              { "_rels/.rels", relations, packed, 0 },
                              { "3D/3dmodel.model", model, packed, claim } };
    archive(entries, 3, zip);
}

static void the_unit_is_the_files(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        WrLengthUnit unit;
    } units[] = { { "", WR_UNIT_MM },
                  { " unit=\"millimeter\"", WR_UNIT_MM },
                  { " xml:lang=\"en\" unit='inch'", WR_UNIT_IN },
                  { " unit=\"micron\"", WR_UNIT_UM },
                  { " unit=\"centimeter\"", WR_UNIT_CM },
                  { " unit=\"foot\"", WR_UNIT_FT },
                  { " unit=\"meter\"", WR_UNIT_M } };
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        for (int packed = 0; packed < 2; packed++) {
            WrText model = { 0 }, zip = { 0 };
            WrMesh mesh = { 0 };
            WrError err = { "" };
            box_model(units[i].text, 7, "", &model);
            file_of(wr_text_get(&model), packed, 0, &zip);
            if (!wr_mesh_read_whole_bytes("a.3mf", zip.data, zip.length, &mesh, &err))
                fail_msg("%s", err.text);
            assert_int_equal(mesh.bad_uv, 0);
            assert_int_equal(mesh.unit, units[i].unit);
            assert_int_equal(mesh.triangle_count, 12);
            float low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { 0, 0, 0 };
            for (int k = 0; k < 3 * mesh.point_count; k++) {
                const float x = mesh.points[k / 3][k % 3];
                low[k % 3] = fminf(low[k % 3], x), high[k % 3] = fmaxf(high[k % 3], x);
            }
            assert_near((double)low[0] + mesh.origin[0], 100, 0); /* in the file's unit */
            for (int k = 0; k < 3; k++) assert_near((double)(high[k] - low[k]), 2 + k, 0);
            wr_mesh_fini(&mesh);
            wr_text_fini(&model);
            wr_text_fini(&zip);
        }
}

/* A mesh or one message that names the file; if `words`, that message. */
static void harmless(const WrText *zip, size_t length, const char *words)
{
    WrMesh mesh = { 0 };
    WrError err = { "" };
    const bool good = wr_mesh_read_whole_bytes("bad.3mf", zip->data, length, &mesh, &err);
    if (words && good) fail_msg("read: %s", words);
    if (!good && !strstr(err.text, words ? words : "bad.3mf: ")) fail_msg("%s", err.text);
    if (good) wr_mesh_fini(&mesh);
}

static void hostile_archives_are_refused(void **state)
{
    (void)state;
    WrText model = { 0 }, zip = { 0 };
    box_model("", 7, "", &model);
    setenv("WRINKLE_READER_SECONDS", "2", 1);
    for (int packed = 0; packed < 2; packed++) {
        wr_text_fini(&zip);
        file_of(wr_text_get(&model), packed, 0, &zip);
        for (size_t n = 1; n < zip.length; n += 97)
            harmless(&zip, n, "bad.3mf: is not a 3MF file, or is truncated");
        for (size_t n = 0; n < zip.length; n += 37) { /* one byte wrong */
            zip.data[n] = (char)~zip.data[n];
            harmless(&zip, zip.length, NULL);
            zip.data[n] = (char)~zip.data[n];
        }
    }
    wr_text_fini(&zip);
    file_of(wr_text_get(&model), true, 0x7fffffff, &zip);
    harmless(&zip, zip.length, "bad.3mf: unpacks to more than 1073741824 bytes");
    wr_text_fini(&zip);
    file_of(wr_text_get(&model), true, 900000000, &zip); /* below the limit of bytes */
    harmless(&zip, zip.length, NULL);
    wr_text_fini(&zip);
    const Entry other[] = { { "a.txt", "nothing", false, 0 } };
    archive(other, 1, &zip);
    harmless(&zip, zip.length, "bad.3mf: damaged: it contains no model");
    unsetenv("WRINKLE_READER_SECONDS");
    wr_text_fini(&zip);
    wr_text_fini(&model);
}

static void hostile_models_are_refused(void **state)
{
    (void)state;
    static const char *const loop =
        "<object id=\"2\"><components><component objectid=\"3\"/></components></object>"
        "<object id=\"3\"><components><component objectid=\"2\"/></components></object>";
    static const int last[] = { 8, -1, 2147483647 };
    WrText model = { 0 }, zip = { 0 };
    setenv("WRINKLE_READER_SECONDS", "2", 1);
    for (int i = 0; i < 3; i++) {
        box_model("", last[i], "", &model);
        file_of(wr_text_get(&model), true, 0, &zip);
        harmless(&zip, zip.length, "bad.3mf: ");
        wr_text_fini(&model);
        wr_text_fini(&zip);
    }
    box_model("", 7, loop, &model);
    file_of(wr_text_get(&model), true, 0, &zip);
    harmless(&zip, zip.length, NULL);
    wr_text_fini(&zip);
    file_of("<model>", false, 0, &zip);
    harmless(&zip, zip.length, "bad.3mf: ");
    unsetenv("WRINKLE_READER_SECONDS");
    wr_text_fini(&model);
    wr_text_fini(&zip);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_unit_is_the_files),
        cmocka_unit_test(hostile_archives_are_refused),
        cmocka_unit_test(hostile_models_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
