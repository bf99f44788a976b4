/* glTF files with separate buffers: read, refused, and recovered after a crash when all of them are gone. */
#include "test.h"
#include "document/journal_help.h"
#include "recovery_help.h"

#include "base/error.h"
#include "base/text.h"
#include "command/session_internal.h"
#include "command/recovery.h"
#include "command/session.h"
#include "image/gltf.h"
#include "image/mesh.h"

#include <sys/stat.h>
#include <unistd.h>

static char *folder;

static int setup(void **state)
{
    if (make_place(state) != 0) return -1;
    folder = *state;
    return setenv("WRINKLE_STATE", folder, 1);
}

/* folder/name */
static const char *at(const char *name)
{
    static char path[4][512];
    static int turn;
    char *out = path[turn++ % 4];
    snprintf(out, sizeof path[0], "%s/%s", folder, name);
    return out;
}

static void put(const char *name, const void *bytes, size_t length)
{
    FILE *file = fopen(at(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    fclose(file);
}

/* A triangle whose points are in one buffer, and its corners, of 16 bits, in another. */
static void put_gltf(const char *name, const char *points, const char *corners)
{
    char text[2048];
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
        "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
        "{\"POSITION\":0},\"indices\":1}]}],\"images\":[{\"uri\":\"no such.png\"}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"},{\"byteLength\":6,\"uri\":\"%s\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":1,\"byteLength\":6}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[9,9,9]},{\"bufferView\":1,\"componentType\":5123,"
        "\"count\":3,\"type\":\"SCALAR\"}]}",
        points, corners);
    put(name, text, strlen(text));
}

static void put_buffers(const char *points, const char *corners, float x)
{
    const float p[9] = { 0.25f, 0, 0, x, 0.5f, 0, 0, 1.75f, 3 };
    const uint16_t c[3] = { 2, 0, 1 };
    put(points, p, sizeof p);
    put(corners, c, sizeof c);
}

static void expect(const char *name, float x)
{
    WrMesh mesh;
    WrError err = { "" };
    if (!wr_mesh_read_attributes(at(name), &mesh, &err)) fail_msg("%s", err.text);
    assert_int_equal(mesh.triangle_count, 1);
    const float *p = mesh.points[mesh.corners[0][2]];
    assert_float_equal(p[0], x, 0);
    assert_float_equal(p[1], 0.5f, 0);
    wr_mesh_fini(&mesh);
}

static void refuse(const char *name, const char *words)
{
    WrMesh mesh;
    WrError err = { "" };
    if (wr_mesh_read(at(name), &mesh, &err)) fail_msg("%s is taken", name);
    if (!strstr(err.text, words)) fail_msg("\"%s\" has not \"%s\"", err.text, words);
    if (!strstr(err.text, name)) fail_msg("\"%s\" does not name %s", err.text, name);
}

static void buffers_beside_and_below_are_taken_in(void **state)
{
    (void)state;
    assert_int_equal(mkdir(at("parts"), 0700), 0);
    put_buffers("points of it.bin", "parts/c.bin", 2.5f);
    put_gltf("a.gltf", "points%20of%20it.bin", "parts/c.bin");
    expect("a.gltf", 2.5f);
    put_gltf("b.GLTF", "points of it.bin", "data:application/octet-stream;base64,AgAAAAEA");
    expect("b.GLTF", 2.5f);
    setenv("WRINKLE_READER", "inside", 1);
    expect("a.gltf", 2.5f);
    unsetenv("WRINKLE_READER");
}

/* Lengths that are not multiples of three bytes: base64 by hand (RFC 4648, 10). */
static void what_is_packed_is_base64(void **state)
{
    static const char *const words[][2] = {
        { "f", "Zg==" }, { "fo", "Zm8=" }, { "foo", "Zm9v" }, { "foob", "Zm9vYg==" }
    };
    (void)state;
    for (int i = 0; i < 4; i++) {
        WrText text = { 0 };
        WrError err = { "" };
        bool packed;
        char want[64];
        put("x.bin", words[i][0], strlen(words[i][0]));
        put("x.gltf", "{\"buffers\":[{\"uri\":\"x.bin\"}]}", 30);
        assert_true(wr_gltf_pack(at("x.gltf"), &text, &packed, &err));
        assert_true(packed);
        snprintf(want, sizeof want, ";base64,%s\"", words[i][1]);
        assert_non_null(strstr(wr_text_get(&text), want));
        wr_text_fini(&text);
    }
}

static void what_lies_elsewhere_is_refused(void **state)
{
    static const char *const names[] = { "../p.bin",   "sub/../p.bin", "%2e%2e/p.bin", "/p.bin",
                                         "file:p.bin", "a\\\\p.bin",   "sub//p.bin",   "p%00.bin" };
    (void)state;
    put_buffers("p.bin", "c.bin", 1);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        put_gltf("thief.gltf", names[i], "c.bin");
        refuse("thief.gltf", "must be in the file's folder or below");
    }
    put_gltf("alone.gltf", "gone.bin", "c.bin");
    refuse("alone.gltf", "gone.bin");
    put_gltf("folder.gltf", ".", "c.bin");
    refuse("folder.gltf", "is a folder");
    put("not.gltf", "{\"buffers\": 7", 13);
    refuse("not.gltf", "not.gltf");
}

/* Two models with buffers of the same name in two folders: names alone would confuse them. */
static void a_crash_loses_neither_of_two_models(void **state)
{
    (void)state;
    WrSession *sessions[2];
    WrError err = { "" };
    WrRecovered how = { 0 };
    mkdir(at("one"), 0700), mkdir(at("two"), 0700);
    put_buffers("one/scene.bin", "one/c.bin", 2.5f);
    put_buffers("two/scene.bin", "two/c.bin", 7.125f);
    put_gltf("one/scene.gltf", "scene.bin", "c.bin");
    put_gltf("two/scene.gltf", "scene.bin", "c.bin");
    const WrSessionOptions options = { .journal = true };
    sessions[0] = wr_session_new(&options);
    for (int i = 0; i < 2; i++) {
        char line[600];
        snprintf(line, sizeof line, "surface mesh file=\"%s\"",
                 at(i ? "two/scene.gltf" : "one/scene.gltf"));
        if (i && !wr_session_run(sessions[0], "object add second", &err)) fail_msg("%s", err.text);
        if (!wr_session_run(sessions[0], line, &err)) fail_msg("%s: %s", line, err.text);
    }
    const WrHash want = wr_session_hash(sessions[0]);
    wr_session_journal_leave(sessions[0]);
    wr_session_free(sessions[0]);
    const char *const gone[] = { "one/scene.bin", "one/c.bin", "two/scene.gltf", "two/c.bin" };
    for (int i = 0; i < 4; i++) assert_int_equal(unlink(at(gone[i])), 0);
    char *journal = only_journal();
    sessions[1] = wr_session_new(&options);
    if (!wr_session_recover(sessions[1], journal, false, &how, &err)) fail_msg("%s", err.text);
    assert_true(how.whole);
    assert_true(wr_hash_equal(wr_session_hash(sessions[1]), want));
    wr_recovered_fini(&how);
    wr_session_free(sessions[1]);
    wr_free(journal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(buffers_beside_and_below_are_taken_in, setup, remove_place),
        cmocka_unit_test_setup_teardown(what_is_packed_is_base64, setup, remove_place),
        cmocka_unit_test_setup_teardown(what_lies_elsewhere_is_refused, setup, remove_place),
        cmocka_unit_test_setup_teardown(a_crash_loses_neither_of_two_models, setup, remove_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
