/* The container of 3MF files: limits on its unpacked size, and the unit of its model. The library reads the
   triangles but passes over both.

   Source: 3MF Core Specification 1.3, 3.4 (model: unit, "millimeter" if missing); PKWARE APPNOTE 6.3, 4.3. */
#include "image/mesh_readers.h"

#include "base/error.h"
#include "image/mesh.h"
#include "image/mesh_build.h"

#include <stdint.h>
#include <string.h>
#include <zlib.h>

#define END 22 /* bytes of the record at the archive's end, before its comment */
#define COMMENT_MAX 65535
#define ENTRY 46 /* bytes of an entry of the directory, before its name */
#define LOCAL 30 /* bytes of an entry's own header, before its name */
#define ENTRIES_MAX 10000
#define HEAD 8192 /* bytes of the model that are searched for its unit */

typedef struct Zip {
    const unsigned char *bytes;
    size_t length;
} Zip;

static uint32_t number(const Zip *zip, size_t at, int size)
{
    uint32_t value = 0;
    for (int i = size; i-- > 0;) value = value << 8 | zip->bytes[at + (size_t)i];
    return value;
}

static bool is_record(const Zip *zip, size_t at, size_t size, const char *mark)
{
    return at <= zip->length && zip->length - at >= size && memcmp(zip->bytes + at, mark, 4) == 0;
}

static bool find_end(const Zip *zip, size_t *at)
{
    if (zip->length < END) return false;
    const size_t last = zip->length - END, first = last > COMMENT_MAX ? last - COMMENT_MAX : 0;
    for (size_t i = last + 1; i-- > first;)
        if (is_record(zip, i, END, "PK\5\6")) {
            *at = i;
            return true;
        }
    return false;
}

/* Unpacks the first bytes of an entry; returns their number, 0 for a damaged one. */
static size_t unpack(const Zip *zip, size_t entry, char out[HEAD])
{
    const uint32_t method = number(zip, entry + 10, 2), local = number(zip, entry + 42, 4);
    if (!is_record(zip, local, LOCAL, "PK\3\4")) return 0;
    const size_t from = local + LOCAL + number(zip, local + 26, 2) + number(zip, local + 28, 2);
    if (from >= zip->length) return 0;
    size_t room = zip->length - from, packed = number(zip, entry + 20, 4);
    if (packed < room) room = packed;
    if (method == 0) {
        if (room > HEAD) room = HEAD;
        memcpy(out, zip->bytes + from, room);
        return room;
    }
    z_stream stream = { .next_in = (unsigned char *)zip->bytes + from,
                        .avail_in = (uInt)room,
                        .next_out = (unsigned char *)out,
                        .avail_out = HEAD };
    if (method != 8 || inflateInit2(&stream, -MAX_WBITS) != Z_OK) return 0;
    (void)inflate(&stream, Z_SYNC_FLUSH);
    inflateEnd(&stream);
    return stream.total_out;
}

/* The value of `unit` in the element `model`. */
static WrLengthUnit unit_of(const char *text)
{
    static const struct {
        const char *name;
        WrLengthUnit unit;
    } units[] = { { "millimeter", WR_UNIT_MM }, { "micron", WR_UNIT_UM },
                  { "centimeter", WR_UNIT_CM }, { "inch", WR_UNIT_IN },
                  { "foot", WR_UNIT_FT },       { "meter", WR_UNIT_M } };
    const char *model = strstr(text, "<model"), *at = model ? strstr(model, " unit=") : NULL;
    if (!at || (size_t)(at - model) > strcspn(model, ">")) return WR_UNIT_MM;
    at += strlen(" unit=");
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        const size_t n = strlen(units[i].name);
        if ((*at == '"' || *at == '\'') && strncmp(at + 1, units[i].name, n) == 0 &&
            at[1 + n] == *at)
            return units[i].unit;
    }
    return WR_UNIT_MM;
}

static bool is_model(const Zip *zip, size_t name, size_t length)
{
    static const char ending[] = ".model";
    return length >= sizeof ending - 1 &&
           memcmp(zip->bytes + name + length - (sizeof ending - 1), ending, sizeof ending - 1) == 0;
}

bool wr_3mf_open(const void *bytes, size_t length, WrMeshBuild *build, WrError *err)
{
    const Zip zip = { bytes, length };
    char text[HEAD + 1];
    size_t end, sum = 0, at, used = 0;
    if (!find_end(&zip, &end))
        return wr_fail(err, "is not a 3MF file, or is truncated: a zip archive without its end");
    const uint32_t count = number(&zip, end + 10, 2);
    at = number(&zip, end + 16, 4);
    if (count > ENTRIES_MAX)
        return wr_fail(err, "has %u entries: at most %d", (unsigned)count, ENTRIES_MAX);
    for (uint32_t i = 0; i < count; i++) {
        if (!is_record(&zip, at, ENTRY, "PK\1\2"))
            return wr_fail(err, "damaged: the archive's directory");
        const size_t name = number(&zip, at + 28, 2);
        const size_t next = at + ENTRY + name + number(&zip, at + 30, 2) + number(&zip, at + 32, 2);
        sum += number(&zip, at + 24, 4);
        if (sum > WR_MESH_FILE_MAX)
            return wr_fail(err, "unpacks to more than %zu bytes", WR_MESH_FILE_MAX);
        if (next > length) return wr_fail(err, "damaged: the archive's directory");
        if (used == 0 && is_model(&zip, at + ENTRY, name)) used = unpack(&zip, at, text);
        at = next;
    }
    if (used == 0) return wr_fail(err, "damaged: it contains no model");
    text[used] = '\0';
    build->unit = unit_of(text);
    return true;
}
