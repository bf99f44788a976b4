/* fuzz_mesh.c - untrusted mesh files, read by the reader process as in the program: any bytes are refused with one
   message or give a mesh with finite points and valid indices. The library may crash on them or read for ever; the
   program must not. The input is a list of edits of a valid file: its first byte selects the file, and whether it is
   truncated at the last edit; three bytes each are a position and a value. */
#include "base/error.h"
#include "image/mesh.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerInitialize(int *argc, char ***argv);

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    setenv("WRINKLE_READER_SECONDS", "1", 1);
    return 0;
}

#define TEXT(name, text)                                                                           \
    {                                                                                              \
        (name), (text), sizeof(text) - 1                                                           \
    }
static const struct {
    const char *name, *bytes;
    size_t length;
} good[] = {
    TEXT("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\ng a\nf 1/1/1 2/1/1 3//1\n"
                  "f 1 3 4 2\nf -1 -2 -3\n"),
    TEXT("a.obj", "# all of it without the library\no b\nv 0 0 0\nv 1.25 0 -2e-1\nv 0 1 0\r\n"
                  "v 0 0 1 .5 1 0\nvt 0 0\nvt 1 .5\nvn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 3/1/1\n"
                  "f 1//1 3//1 4//1 2//1\ng c\nf -1 -2 -3\nf 4/2 2/1 1/2\n"),
    TEXT("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                  "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                  "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
    TEXT("a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                  "property float y\nproperty float z\nelement face 1\n"
                  "property list uchar int vertex_indices\nend_header\n"
                  "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0"
                  "\3\0\0\0\0\1\0\0\0\2\0\0\0"),
    TEXT("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                  "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"),
    TEXT("a.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n4 0 1 2 3\n"),
    TEXT("a.gltf",
         "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
         "\"nodes\":[{\"mesh\":0,\"scale\":[2,2,2]}],"
         "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
         "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
         "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
         "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
         "\"min\":[0,0,0],\"max\":[1,1,0]}]}"),
};
#undef TEXT
#define KINDS (sizeof good / sizeof *good)

static void require(bool condition)
{
    if (!condition) abort();
}

static void check(const WrMesh *mesh)
{
    require(mesh->point_count >= 3 && mesh->triangle_count >= 1);
    for (int i = 0; i < mesh->point_count; i++)
        for (int k = 0; k < 3; k++) require(isfinite(mesh->points[i][k]));
    for (int i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            require(mesh->corners[i][k] >= 0 && mesh->corners[i][k] < mesh->point_count);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char bytes[1024];
    if (size < 1) return 0;
    size_t kind = data[0] % KINDS, length = good[kind].length, at = length;
    memcpy(bytes, good[kind].bytes, length);
    for (size_t i = 1; i + 2 < size; i += 3) {
        at = (data[i] | (size_t)data[i + 1] << 8) % length;
        bytes[at] = (char)data[i + 2];
    }
    if (data[0] & 128) length = at + 1 < length ? at + 1 : length;
    WrError err = { "" };
    WrMesh mesh = { 0 };
    if (wr_mesh_read_bytes(good[kind].name, bytes, length, &mesh, &err)) {
        check(&mesh);
        wr_mesh_fini(&mesh);
    } else {
        require(strstr(err.text, good[kind].name) && !mesh.block);
    }
    return 0;
}
