/* Generators that read files, as commands: the line stores the checksum of the file, and checks it later. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "command/session.h"
#include "image/image.h"

typedef struct Case {
    const char *line, *file;
} Case;

static const Case cases[] = {
    { "solid mesh a.obj size=40", "a.obj" },
    { "terrain elevation a.r16 size=8x8", "a.r16" },
    { "picture photo a.png seamless=off", "a.png" },
    { "picture normals a.png y=up", "a.png" },
    { "picture paste a.png", "a.png" },
};
#define CASES (sizeof cases / sizeof *cases)

static void write_file(const char *name, const void *bytes, size_t length)
{
    WrError err;
    if (!wr_file_write(name, bytes, length, &err)) fail_msg("%s", err.text);
}

/* Each file with one of two contents. */
static void write_files(int which)
{
    WrError err;
    uint8_t texels[768];
    uint16_t codes[64];
    static const char *const meshes[] = { "v 0 0 0\nv 4 0 1\nv 4 4 2\nv 0 4 3\nf 1 2 3 4\n",
                                          "v 0 0 0\nv 4 0 3\nv 4 4 2\nv 0 4 1\nf 1 2 3 4\n" };
    write_file("a.obj", meshes[which], strlen(meshes[which]));
    for (int k = 0; k < 64; k++) codes[k] = (uint16_t)(k * k * 3 + which * 5000);
    write_file("a.r16", codes, sizeof codes);
    for (int k = 0; k < 768; k++)
        texels[k] = (uint8_t)(k % 3 == 2 ? 200 : 128 + (k * (7 + which)) % 30);
    if (!wr_image_write_pixels("a.png", 16, 16, 3, WR_PIXEL_U8, true, texels, &err))
        fail_msg("%s", err.text);
}

static void lines_learn_the_hash_of_their_file(void **state)
{
    (void)state;
    write_files(0);
    for (size_t k = 0; k < CASES; k++) {
        WrSession *s = session_of((const char *[]){ "table 64x64", NULL });
        char hex[65], want[90];
        WrError err;
        must_run(s, cases[k].line);
        if (!wr_sha256_file(cases[k].file, hex, &err)) fail_msg("%s", err.text);
        snprintf(want, sizeof want, " sha256=%s", hex);
        if (!strstr(wr_session_last_command(s), want))
            fail_msg("%s has not%s", wr_session_last_command(s), want);
        wr_session_free(s);
    }
}

static void a_file_of_another_content_is_refused_and_nothing_changes(void **state)
{
    (void)state;
    for (size_t k = 0; k < CASES; k++) {
        char line[500];
        write_files(0);
        WrSession *s = session_of((const char *[]){ "table 64x64", NULL });
        must_run(s, cases[k].line);
        snprintf(line, sizeof line, "%s", wr_session_last_command(s));
        WrHash made = wr_session_hash(s);
        must_run(s, "undo");
        must_run(s, line); /* the file is unchanged */
        assert_true(wr_hash_equal(made, wr_session_hash(s)));
        write_files(1);
        must_fail(s, line, "file has changed");
        must_run(s, cases[k].line); /* without its checksum the present content is used */
        assert_false(wr_hash_equal(made, wr_session_hash(s)));
        wr_session_free(s);
    }
}

static void files_that_are_not_there_or_make_no_sense_are_named(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 32x32", "fill 0.25", NULL });
    static const char bad[] = "v 0 0 0\nv 1 nan 0\nv 1 1 1\nf 1 2 3\n";
    write_file("bad.obj", bad, sizeof bad - 1);
    write_file("bad.png", "\x89PNG\r\n\x1a\nnothing", 15);
    must_fail(s, "solid mesh none.obj", "none.obj");
    must_fail(s, "solid mesh bad.obj", "point 2");
    must_fail(s, "terrain elevation none.r16", "none.r16");
    must_fail(s, "terrain elevation bad.obj", "bad.obj");
    must_fail(s, "picture photo bad.png", "bad.png");
    must_fail(s, "picture normals none.png", "none.png");
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_learn_the_hash_of_their_file),
        cmocka_unit_test(a_file_of_another_content_is_refused_and_nothing_changes),
        cmocka_unit_test(files_that_are_not_there_or_make_no_sense_are_named),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
