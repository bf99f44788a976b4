/* Mesh files of several kinds, and files that are invalid, damaged or malicious. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/mesh.h"

#include <sys/stat.h>
#include <unistd.h>

static WrMesh read_text(const char *name, const char *text)
{
    WrMesh mesh = { 0 };
    WrError err = { "" };
    if (!wr_mesh_read_bytes(name, text, strlen(text), &mesh, &err)) fail_msg("%s", err.text);
    return mesh;
}

static void refuse(const char *name, const void *bytes, size_t length, const char *words)
{
    WrMesh mesh = { 0 };
    WrError err = { "" };
    if (wr_mesh_read_bytes(name, bytes, length, &mesh, &err)) fail_msg("%s is taken", name);
    if (!strstr(err.text, words)) fail_msg("\"%s\" has not \"%s\"", err.text, words);
    if (!strstr(err.text, name)) fail_msg("\"%s\" does not name %s", err.text, name);
    assert_null(mesh.block);
}

/* Sum of areas, and the signed volume, which is independent of the origin for a closed surface. */
static void measures(const WrMesh *mesh, double *area, double *volume)
{
    *area = *volume = 0.0;
    for (int t = 0; t < mesh->triangle_count; t++) {
        double p[3][3], e[2][3], n[3];
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++)
                p[k][c] = (double)mesh->points[mesh->corners[t][k]][c] + 5.0;
        for (int c = 0; c < 3; c++) {
            e[0][c] = p[1][c] - p[0][c];
            e[1][c] = p[2][c] - p[0][c];
        }
        for (int c = 0; c < 3; c++)
            n[c] = e[0][(c + 1) % 3] * e[1][(c + 2) % 3] - e[0][(c + 2) % 3] * e[1][(c + 1) % 3];
        *area += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        *volume += (p[0][0] * n[0] + p[0][1] * n[1] + p[0][2] * n[2]) / 6.0;
    }
}

static void expect_box(WrMesh *mesh, double x, double y, double z)
{
    double area, volume;
    measures(mesh, &area, &volume);
    assert_near(area, 2.0 * (x * y + y * z + z * x), 1e-4);
    assert_near(volume, x * y * z, 1e-4);
    wr_mesh_fini(mesh);
    assert_null(mesh->block);
}

/* ---- kinds ---- */

static const char box_obj[] =
    "# a box of 2 x 3 x 4\nmtllib /etc/passwd\nv 0 0 0\nv 2 0 0\nv 2 3 0\n"
    "v 0 3 0\nv 0 0 4\nv 2 0 4\nv 2 3 4\nv 0 3 4\nusemtl none\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

static void an_obj_file_of_quadrilaterals_becomes_triangles(void **state)
{
    (void)state;
    WrMesh mesh = read_text("box.obj", box_obj);
    assert_int_equal(mesh.triangle_count, 12);
    expect_box(&mesh, 2, 3, 4);
}

static const char box_ply[] = "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty "
                              "float y\nproperty float z\n"
                              "element face 6\nproperty list uchar int "
                              "vertex_indices\nend_header\n0 0 0\n2 0 0\n2 3 0\n0 3 0\n"
                              "0 0 4\n2 0 4\n2 3 4\n0 3 4\n4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 "
                              "6 5\n4 2 3 7 6\n4 3 0 4 7\n";

static void a_ply_file_is_read(void **state)
{
    (void)state;
    WrMesh mesh = read_text("box.ply", box_ply);
    expect_box(&mesh, 2, 3, 4);
}

/* A tetrahedron, binary: 80 bytes of title, a count, records of 50 bytes. */
static size_t tetrahedron_stl(char *out)
{
    static const float p[4][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    static const int faces[4][3] = { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } };
    const uint32_t count = 4;
    memset(out, 0, 84 + 4 * 50);
    memcpy(out + 80, &count, 4);
    for (int f = 0; f < 4; f++)
        for (int k = 0; k < 3; k++) memcpy(out + 84 + 50 * f + 12 + 12 * k, p[faces[f][k]], 12);
    return 84 + 4 * 50;
}

static void a_binary_stl_file_is_read(void **state)
{
    (void)state;
    char bytes[512];
    WrMesh mesh = { 0 };
    WrError err = { "" };
    double area, volume;
    if (!wr_mesh_read_bytes("t.stl", bytes, tetrahedron_stl(bytes), &mesh, &err))
        fail_msg("%s", err.text);
    measures(&mesh, &area, &volume);
    assert_near(volume, 1.0 / 6.0, 1e-6);
    assert_near(area, 1.5 + sqrt(3.0) / 2.0, 1e-6);
    wr_mesh_fini(&mesh);
}

/* One triangle of area 1/2, with embedded buffer; two nodes, one scaled by two and rotated on its side. */
static const char triangle_gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
    "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"scale\":[2,2,2],\"rotation\":[0.7071067811865476,0,0,"
    "0.7071067811865476],\"translation\":[0,0,7]}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
    "\"min\":[0,0,0],\"max\":[1,1,0]}]}";

static size_t put(char *out, size_t at, const void *from, size_t size, bool turned)
{
    for (size_t k = 0; k < size; k++) out[at + k] = ((const char *)from)[turned ? size - 1 - k : k];
    return at + size;
}

/* The box of box_obj, in both byte orders (this machine is assumed to be little-endian). */
static void a_binary_ply_file_of_either_order_is_read(void **state)
{
    (void)state;
    static const int32_t faces[6][4] = { { 3, 2, 1, 0 }, { 4, 5, 6, 7 }, { 0, 1, 5, 4 },
                                         { 1, 2, 6, 5 }, { 2, 3, 7, 6 }, { 3, 0, 4, 7 } };
    for (int big = 0; big < 2; big++) {
        char bytes[1024];
        size_t at = (size_t)snprintf(bytes, sizeof bytes,
                                     "ply\nformat binary_%s_endian 1.0\nelement vertex 8\n"
                                     "property float x\nproperty float y\nproperty float z\n"
                                     "element face 6\nproperty list uchar int vertex_indices\n"
                                     "end_header\n",
                                     big ? "big" : "little");
        for (int k = 0; k < 8; k++) {
            const float p[3] = { (k + 1) / 2 % 2 ? 2.0f : 0.0f, k / 2 % 2 ? 3.0f : 0.0f,
                                 k > 3 ? 4.0f : 0.0f };
            for (int c = 0; c < 3; c++) at = put(bytes, at, &p[c], 4, big);
        }
        for (int f = 0; f < 6; f++) {
            bytes[at++] = 4;
            for (int k = 0; k < 4; k++) at = put(bytes, at, &faces[f][k], 4, big);
        }
        WrMesh mesh = { 0 };
        WrError err = { "" };
        if (!wr_mesh_read_bytes("box.ply", bytes, at, &mesh, &err)) fail_msg("%s", err.text);
        expect_box(&mesh, 2, 3, 4);
    }
}

static void a_written_out_stl_file_is_read(void **state)
{
    (void)state;
    static const int p[4][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    static const int faces[4][3] = { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } };
    WrText text = { 0 };
    double area, volume;
    wr_text_addf(&text, "solid t\n");
    for (int f = 0; f < 4; f++) {
        wr_text_addf(&text, "facet normal 0 0 0\nouter loop\n");
        for (int k = 0; k < 3; k++)
            wr_text_addf(&text, "vertex %d %d %d\n", p[faces[f][k]][0], p[faces[f][k]][1],
                         p[faces[f][k]][2]);
        wr_text_addf(&text, "endloop\nendfacet\n");
    }
    wr_text_addf(&text, "endsolid t\n");
    WrMesh mesh = read_text("t.stl", wr_text_get(&text));
    measures(&mesh, &area, &volume);
    assert_near(area, 1.5 + 0.5 * sqrt(3.0), 1e-5);
    assert_near(volume, 1.0 / 6.0, 1e-5);
    wr_mesh_fini(&mesh);
    wr_text_fini(&text);
}

/* One triangle: a JSON chunk and a binary chunk, each padded to four bytes. */
static void a_glb_file_is_read(void **state)
{
    (void)state;
    static const float points[9] = { 0, 0, 0, 2, 0, 0, 0, 3, 0 };
    char json[600], bytes[800];
    int length = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"
        "\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"buffers\":[{\"byteLength\":36}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":"
        "\"VEC3\",\"min\":[0,0,0],\"max\":[2,3,0]}]}");
    while (length % 4) json[length++] = ' ';
    const uint32_t head[3] = { 0x46546c67, 2, (uint32_t)length + 12 + 8 + 8 + 36 };
    const uint32_t first[2] = { (uint32_t)length, 0x4e4f534a }, second[2] = { 36, 0x004e4942 };
    size_t at = put(bytes, 0, head, sizeof head, false);
    at = put(bytes, at, first, sizeof first, false);
    at = put(bytes, at, json, (size_t)length, false);
    at = put(bytes, at, second, sizeof second, false);
    at = put(bytes, at, points, sizeof points, false);
    WrMesh mesh = { 0 };
    WrError err = { "" };
    double area, volume;
    if (!wr_mesh_read_bytes("t.glb", bytes, at, &mesh, &err)) fail_msg("%s", err.text);
    measures(&mesh, &area, &volume);
    assert_near(area, 3.0, 1e-6);
    assert_int_equal(mesh.triangle_count, 1);
    wr_mesh_fini(&mesh);
}

static void the_nodes_of_a_gltf_file_are_put_where_they_belong(void **state)
{
    (void)state;
    WrMesh mesh = read_text("two.gltf", triangle_gltf);
    double area, volume, high = 0.0;
    assert_int_equal(mesh.triangle_count, 2);
    measures(&mesh, &area, &volume);
    assert_near(area, 0.5 + 2.0, 1e-5);
    for (int i = 0; i < mesh.point_count; i++) high = fmax(high, (double)mesh.points[i][2]);
    assert_near(high, 9.0, 1e-5); /* its doubled y goes up from 7 */
    wr_mesh_fini(&mesh);
}

static void a_mesh_is_the_same_from_memory_from_a_file_and_inside(void **state)
{
    (void)state;
    char path[] = "/tmp/wrinkle-mesh-XXXXXX.obj";
    int fd = mkstemps(path, 4);
    assert_int_equal(write(fd, box_obj, sizeof box_obj - 1), (ssize_t)sizeof box_obj - 1);
    close(fd);
    WrMesh a = read_text("box.obj", box_obj), b = { 0 }, c = { 0 };
    WrError err = { "" };
    if (!wr_mesh_read(path, &b, &err)) fail_msg("%s", err.text);
    setenv("WRINKLE_READER", "inside", 1);
    bool good = wr_mesh_read(path, &c, &err);
    unsetenv("WRINKLE_READER");
    if (!good) fail_msg("%s", err.text);
    size_t points = (size_t)a.point_count * 12, corners = (size_t)a.triangle_count * 12;
    assert_int_equal(a.point_count, b.point_count);
    assert_int_equal(a.point_count, c.point_count);
    assert_memory_equal(a.points, b.points, points);
    assert_memory_equal(a.points, c.points, points);
    assert_memory_equal(a.corners, b.corners, corners);
    assert_memory_equal(a.corners, c.corners, corners);
    wr_mesh_fini(&a);
    wr_mesh_fini(&b);
    wr_mesh_fini(&c);
    unlink(path);
}

/* ---- invalid files ---- */

static void a_point_that_is_not_finite_is_named(void **state)
{
    (void)state;
    static const char nan_ply[] =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 nan 0\n0 0 inf\n3 0 1 2\n";
    refuse("odd.ply", nan_ply, sizeof nan_ply - 1, "point 3 is 0,nan,0: coordinates are numbers");
    char stl[512];
    const float far = 3e38f;
    size_t length = tetrahedron_stl(stl);
    memcpy(stl + 84 + 12 + 4, &far, 4);
    refuse("far.stl", stl, length, "are numbers from -1e30 to 1e30");
    /* by its number in the file, not by the order of its use */
    static const char nan_obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 7 nan 2\nf 1 2 4\nf 2 3 4\n";
    refuse("nan.obj", nan_obj, sizeof nan_obj - 1, "point 4 is 7,nan,2");
}

/* (u,v) that are no numbers are missing; how many points have them, and where the first one is. */
static void coordinates_of_textures_that_are_no_numbers_are_counted(void **state)
{
    (void)state;
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 5 7\nvt 0 0\nvt 1 0\n"
                              "vt nan 1\nvt 0 2e6\nvt 0.5 inf\n"
                              "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 1/1 2/2 5/5\n";
    static const char ply[] =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nproperty float u\nproperty float v\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "1000 0 0 0 0\n1001 0 0 1 0\n1000 1 3 nan 0\n1000 0 1 0 1\n3 0 1 2\n";
    for (int k = 0; k < 2; k++) {
        const char *text = k ? ply : obj;
        WrMesh mesh = { 0 };
        WrError err = { "" };
        if (!wr_mesh_read_whole_bytes(k ? "a.ply" : "a.obj", text, strlen(text), &mesh, &err))
            fail_msg("%s", err.text);
        assert_int_equal(mesh.bad_uv, k ? 1 : 3);
        assert_near(mesh.bad_uv_at[0], k ? 1000 : 1, 0); /* not from where the mesh was moved to */
        assert_near(mesh.bad_uv_at[1], 1, 0);
        assert_near(mesh.bad_uv_at[2], k ? 3 : 0, 0);
        int missing = 0;
        for (int32_t i = 0; i < mesh.point_count; i++)
            missing += isnan(mesh.uv[i][0]) && isnan(mesh.uv[i][1]);
        assert_int_equal(missing, k ? 1 : 3);
        wr_mesh_fini(&mesh);
    }
    static const char plain[] =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 3\n3 0 1 2\n"; /* a file without (u,v) has no faulty ones */
    WrMesh mesh = { 0 };
    WrError err = { "" };
    if (!wr_mesh_read_whole_bytes("a.ply", plain, strlen(plain), &mesh, &err))
        fail_msg("%s", err.text);
    assert_int_equal(mesh.bad_uv, 0);
    wr_mesh_fini(&mesh);
}

/* Files of another kind than their names. */
static void other_contents_are_named(void **state)
{
    (void)state;
    static const char png[] =
        "\x89PNG\r\n\x1a\n-rest-of-a-picture-that-is-longer-than-a-head-of-80-"
        "bytes-which-STL-has-rest-of-a-picture",
                      zip[] = "PK\3\4.............................",
                      letter[] = "Dear Sir,\nvery long lines of a letter\n";
    char stl[512];
    const size_t length = tetrahedron_stl(stl);
    refuse("a.stl", png, sizeof png - 1, "is not a valid STL file: its content is a PNG picture");
    refuse("a.obj", png, sizeof png - 1, "is not a valid OBJ file: its content is a PNG picture");
    refuse("a.ply", png, sizeof png - 1, "is not a valid PLY file: its content is a PNG picture");
    refuse("a.3mf", png, sizeof png - 1, "is not a valid 3MF file: its content is a PNG picture");
    refuse("a.glb", zip, sizeof zip - 1, "is not a valid GLB file: its content is a zip archive");
    refuse("a.ply", stl, length, "is not a valid PLY file: its content is an STL file");
    refuse("a.obj", stl, length, "is not a valid OBJ file: its content is an STL file");
    refuse("b.stl", box_obj, sizeof box_obj - 1,
           "is not a valid STL file: its content is an OBJ file");
    refuse("c.obj", letter, sizeof letter - 1,
           "is not a valid OBJ file: its content is plain text");
    /* the right kind, but damaged */
    refuse("cut.stl", stl, length - 1,
           "cut.stl: is damaged or truncated: its header has 4 triangles");
    refuse("cut.3mf", zip, sizeof zip - 1, "cut.3mf: is not a 3MF file, or is truncated");
}

/* 3 000 001 triangles with three points each, which STL files do not share. */
static void an_stl_file_has_fewer_triangles(void **state)
{
    (void)state;
    const uint32_t count = WR_MESH_POINTS_MAX / 3 + 1;
    const size_t length = 84 + 50 * (size_t)count;
    char *stl = calloc(length, 1);
    assert_non_null(stl);
    memcpy(stl + 80, &count, 4);
    refuse("big.stl", stl, length, "more than 3000000 triangles");
    refuse("big.stl", stl, length, "may have 9000000");
    free(stl);
}

static void files_that_are_no_meshes_are_refused_with_a_reason(void **state)
{
    (void)state;
    static const char points[] = "v 0 0 0\nv 1 1 1\nv 2 0 0\nl 1 2 3\n";
    refuse("points.obj", points, sizeof points - 1, "points.obj: ");
    refuse("a.png", "\x89PNG\r\n\x1a\n", 8, "of a kind that can be read (.png)");
    refuse("a.ply", "hel\1o", 5, "is not a PLY file");
    refuse("a.obj", "", 0, "0 bytes: must be");
    /* Header counts without data. */
    static const char vertices[] = "ply\nformat ascii 1.0\nelement vertex 2147483647\nend_header\n";
    refuse("much.ply", vertices, sizeof vertices - 1,
           "is damaged: its header has 2147483647 elements");
    static const char faces[] = "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\n"
                                "element face   4000000000 \r\nend_header\r\n1234";
    refuse("much.obj", faces, sizeof faces - 1,
           "is damaged: its header has 4000000000 elements, but the file only 4 bytes");
    WrMesh mesh = { 0 };
    WrError err = { "" };
    assert_false(wr_mesh_read("/nowhere/a.obj", &mesh, &err));
    assert_non_null(strstr(err.text, "/nowhere/a.obj: No such file"));
    assert_false(wr_mesh_read("/tmp", &mesh, &err));
    assert_non_null(strstr(err.text, "is a folder"));
    assert_false(wr_mesh_read("/dev/zero", &mesh, &err));
    assert_non_null(strstr(err.text, "is a device"));
}

/* A buffer in another existing file, which must not be opened. */
static void what_a_file_points_to_is_not_opened(void **state)
{
    (void)state;
    char other[] = "/tmp/wrinkle-mesh-XXXXXX.bin", gltf[2048], *uri;
    int fd = mkstemps(other, 4);
    const float points[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    assert_int_equal(write(fd, points, sizeof points), (ssize_t)sizeof points);
    close(fd);
    strcpy(gltf, triangle_gltf);
    uri = strstr(gltf, "data:");
    char *rest = strdup(strchr(uri, '"'));
    strcpy(uri, other);
    strcat(gltf, rest);
    refuse("thief.gltf", gltf, strlen(gltf), "needs another file");
    setenv("WRINKLE_READER", "inside", 1);
    refuse("thief.gltf", gltf, strlen(gltf), "needs another file");
    memcpy(strstr(gltf, "2.0"), "1.0", 3);
    refuse("old.gltf", gltf, strlen(gltf), "glTF 1.0, which is not read: save it as glTF 2.0");
    unsetenv("WRINKLE_READER");
    free(rest);
    unlink(other);
}

/* Every length up to the whole: a mesh or one message. The same for out-of-range indices. */
static void truncated_files_and_wild_indices_are_harmless(void **state)
{
    (void)state;
    char stl[512], text[sizeof box_ply];
    size_t length = tetrahedron_stl(stl);
    WrError err = { "" };
    WrMesh mesh;
    setenv("WRINKLE_READER_SECONDS", "1", 1); /* some damaged files are read for ever */
    for (size_t n = 1; n < length; n += 17) {
        if (wr_mesh_read_bytes("cut.stl", stl, n, &mesh, &err)) wr_mesh_fini(&mesh);
        else assert_non_null(strstr(err.text, "cut.stl: "));
    }
    for (size_t n = 1; n < sizeof box_ply; n += 71) {
        if (wr_mesh_read_bytes("cut.ply", box_ply, n, &mesh, &err)) wr_mesh_fini(&mesh);
        else assert_non_null(strstr(err.text, "cut.ply: "));
    }
    strcpy(text, box_ply);
    memcpy(strstr(text, "4 3 2 1 0"), "4 3 2 1 9", 9);
    if (wr_mesh_read_bytes("wild.ply", text, strlen(text), &mesh, &err)) {
        for (int i = 0; i < mesh.triangle_count * 3; i++)
            assert_true(mesh.corners[i / 3][i % 3] < mesh.point_count);
        wr_mesh_fini(&mesh);
    }
    unsetenv("WRINKLE_READER_SECONDS");
}

/* A header with a count beyond memory ends in one message, and the next file is read. */
static void a_file_that_promises_too_much_is_refused(void **state)
{
    (void)state;
    static const char huge[] =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
        "property float y\nproperty float z\nelement face 4000000000\n"
        "property list uchar int vertex_indices\nend_header\nabc";
    refuse("huge.ply", huge, sizeof huge - 1, "huge.ply: ");
    char stl[512];
    size_t length = tetrahedron_stl(stl);
    memset(stl + 80, 0xff, 4);
    refuse("huge.stl", stl, length, "huge.stl: ");
    WrMesh mesh = read_text("box.obj", box_obj);
    expect_box(&mesh, 2, 3, 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_obj_file_of_quadrilaterals_becomes_triangles),
        cmocka_unit_test(a_ply_file_is_read),
        cmocka_unit_test(a_binary_stl_file_is_read),
        cmocka_unit_test(a_binary_ply_file_of_either_order_is_read),
        cmocka_unit_test(a_written_out_stl_file_is_read),
        cmocka_unit_test(a_glb_file_is_read),
        cmocka_unit_test(the_nodes_of_a_gltf_file_are_put_where_they_belong),
        cmocka_unit_test(a_mesh_is_the_same_from_memory_from_a_file_and_inside),
        cmocka_unit_test(a_point_that_is_not_finite_is_named),
        cmocka_unit_test(coordinates_of_textures_that_are_no_numbers_are_counted),
        cmocka_unit_test(other_contents_are_named),
        cmocka_unit_test(an_stl_file_has_fewer_triangles),
        cmocka_unit_test(files_that_are_no_meshes_are_refused_with_a_reason),
        cmocka_unit_test(what_a_file_points_to_is_not_opened),
        cmocka_unit_test(truncated_files_and_wild_indices_are_harmless),
        cmocka_unit_test(a_file_that_promises_too_much_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
