#include "image/mesh.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/gltf.h"
#include "image/mesh_decode.h"
#include "image/reader_client.h"
#include "system/fd.h"

#include <math.h>
#include <string.h>

const char *const wr_mesh_endings[] = { WR_MESH_ENDINGS, NULL };

bool wr_mesh_named(const char *path)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    for (const char *const *known = wr_mesh_endings; *known; known++)
        if (strcmp(ending, *known) == 0) return true;
    return false;
}

/* ---- results of the reader ---- */

/* Normals and (u,v) may have any value; parts must be contiguous and cover all triangles. */
static bool check_whole(const char *rest, WrMeshHead head, WrMesh *mesh)
{
    const char *uv = rest + 12 * (size_t)head.points, *parts = uv + 8 * (size_t)head.points;
    mesh->normals = (const float(*)[3])(const void *)rest;
    mesh->uv = (const float(*)[2])(const void *)uv;
    mesh->parts = (const WrMeshPart *)(const void *)parts;
    mesh->part_count = head.parts;
    int32_t sum = 0;
    for (int32_t i = 0; i < head.parts; i++) {
        const WrMeshPart *part = &mesh->parts[i];
        if (part->first != sum || part->count < 1 || part->count > head.triangles - sum ||
            !memchr(part->name, 0, sizeof part->name))
            return false;
        sum += part->count;
    }
    return sum == head.triangles;
}

/* The block is untrusted. */
static bool check_block(const char *block, size_t length, WrMesh *mesh)
{
    WrMeshHead head;
    if (length < sizeof head) return false;
    memcpy(&head, block, sizeof head);
    if (head.points < 3 || head.points > WR_MESH_POINTS_MAX || head.triangles < 1 ||
        head.triangles > WR_MESH_TRIANGLES_MAX || head.whole < 0 || head.whole > 1 ||
        head.unit < 0 || head.unit >= WR_UNIT_COUNT || head.bad_uv < 0 || head.parts < head.whole ||
        head.parts > head.whole * WR_MESH_PARTS_MAX ||
        length != sizeof head + 12 * ((size_t)head.points + (size_t)head.triangles) +
                      (head.whole ? 20 * (size_t)head.points : 0) +
                      (size_t)head.parts * sizeof(WrMeshPart))
        return false;
    const char *points = block + sizeof head, *corners = points + 12 * (size_t)head.points;
    mesh->points = (const float(*)[3])(const void *)points;
    mesh->corners = (const int32_t(*)[3])(const void *)corners;
    mesh->point_count = head.points;
    mesh->triangle_count = head.triangles;
    mesh->single = head.single != 0;
    mesh->unit = (WrLengthUnit)head.unit;
    mesh->bad_uv = head.bad_uv;
    for (int k = 0; k < 3; k++) {
        if (!(fabs(head.origin[k]) <= 1e30 && fabs(head.bad_uv_at[k]) <= 1e30)) return false;
        mesh->origin[k] = head.origin[k];
        mesh->bad_uv_at[k] = head.bad_uv_at[k];
    }
    for (int32_t i = 0; i < head.points; i++)
        for (int k = 0; k < 3; k++)
            if (!(fabsf(mesh->points[i][k]) <= 1e30f)) return false;
    for (int32_t i = 0; i < head.triangles; i++)
        for (int k = 0; k < 3; k++)
            if (mesh->corners[i][k] < 0 || mesh->corners[i][k] >= head.points) return false;
    return !head.whole || check_whole(corners + 12 * (size_t)head.triangles, head, mesh);
}

/* Owns the block on success. */
static bool take(const char *name, char *block, size_t length, WrMesh *out, WrError *err)
{
    WrMesh mesh = { .block = block };
    if (check_block(block, length, &mesh)) {
        *out = mesh;
        return true;
    }
    wr_free(block);
    return wr_fail(
        err, "%s: the reader process returned invalid data; the file is damaged or hostile", name);
}

void wr_mesh_fini(WrMesh *mesh)
{
    wr_free(mesh->block);
    *mesh = (WrMesh){ 0 };
}

/* ---- files ---- */

/* The input of a read: source and extent. */
typedef struct Order {
    const char *name;
    bool whole;
} Order;

/* Reads within this process, for debugging. */
static bool read_inside(Order order, const void *bytes, size_t length, WrMesh *out, WrError *err)
{
    WrText block = { 0 };
    char ending[16];
    if (wr_mesh_make(bytes, length, wr_path_ending(order.name, ending), order.whole, &block, NULL,
                     err))
        return take(order.name, block.data, block.length, out, err);
    wr_text_fini(&block);
    wr_error_prefix(err, "%s: ", order.name);
    return false;
}

static bool read_outside(Order order, int fd, WrMesh *out, WrError *err)
{
    char *block;
    size_t length;
    return wr_reader_block(order.name, fd, WR_WIRE_MESH, WR_MESH_WHOLE, order.whole ? 1 : 0, &block,
                           &length, err) &&
           take(order.name, block, length, out, err);
}

static bool read_alone(const char *path, bool whole, WrMesh *out, WrError *err)
{
    const Order order = { path, whole };
    int fd = wr_reader_file(path, WR_MESH_FILE_MAX, err);
    if (fd < 0) return false;
    bool good;
    if (wr_reader_inside()) {
        char *bytes;
        size_t length;
        good = wr_file_read(path, WR_MESH_FILE_MAX, &bytes, &length, err);
        if (good) {
            good = read_inside(order, bytes, length, out, err);
            wr_free(bytes);
        }
    } else {
        good = read_outside(order, fd, out, err);
    }
    wr_fd_close(fd);
    return good;
}

static bool read_bytes(const char *name, const void *bytes, size_t length, bool whole, WrMesh *out,
                       WrError *err)
{
    const Order order = { name, whole };
    if (length == 0 || length > WR_MESH_FILE_MAX)
        return wr_fail(err, "%s: %zu bytes: must be 1..%zu", name, length, WR_MESH_FILE_MAX);
    if (wr_reader_inside()) return read_inside(order, bytes, length, out, err);
    int fd = wr_fd_in_memory(name, bytes, length, err);
    if (fd < 0) return false;
    bool good = read_outside(order, fd, out, err);
    wr_fd_close(fd);
    return good;
}

static bool read_file(const char *path, bool whole, WrMesh *out, WrError *err)
{
    WrText text = { 0 };
    bool packed, good = wr_gltf_pack(path, &text, &packed, err);
    if (good && packed) good = read_bytes(path, text.data, text.length, whole, out, err);
    else if (good) good = read_alone(path, whole, out, err);
    wr_text_fini(&text);
    return good;
}

bool wr_mesh_read(const char *path, WrMesh *out, WrError *err)
{
    return read_file(path, false, out, err);
}

bool wr_mesh_read_attributes(const char *path, WrMesh *out, WrError *err)
{
    return read_file(path, true, out, err);
}

bool wr_mesh_read_bytes(const char *name, const void *bytes, size_t length, WrMesh *out,
                        WrError *err)
{
    return read_bytes(name, bytes, length, false, out, err);
}

bool wr_mesh_read_whole_bytes(const char *name, const void *bytes, size_t length, WrMesh *out,
                              WrError *err)
{
    return read_bytes(name, bytes, length, true, out, err);
}
