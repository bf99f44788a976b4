/* The verb `text`: effect of a line on a document, and the stored line. */
#include "test.h"
#include "session_help.h"

#include "base/memory.h"
#include "command/session.h"

#define SANS_FILE "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"

/* HC78 */
static void hc78_an_empty_text_leaves_every_bit_as_it_was(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(NULL);
    must_run(s, "table 96x64");
    must_run(s, "noise perlin cells=3 octaves=2");
    WrHash before = wr_session_hash(s);
    must_run(s, "text \"\"");
    must_run(s, "text \" \" font=sans blend=replace");
    must_run(s, "text \"far off\" edge=clip at=9,9 blend=replace");
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    must_run(s, "text i");
    assert_false(wr_hash_equal(before, wr_session_hash(s)));
    wr_session_free(s);
}

/* Several lines of text: \n in the command language is two characters, and the stored line is the same. */
static void hc78_new_lines_survive_being_kept(void **state)
{
    (void)state;
    WrSession *a = wr_session_new(NULL), *b = wr_session_new(NULL), *c = wr_session_new(NULL);
    must_run(a, "table 64x64");
    must_run(b, "table 64x64");
    must_run(c, "table 64x64");
    must_run(a, "text \"ab\\\\nc\" size=16");
    char *kept = wr_strdup(wr_session_last_command(a));
    must_run(b, kept);
    must_run(c, "text \"ab c\" size=16");
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    assert_false(wr_hash_equal(wr_session_hash(a), wr_session_hash(c)));
    wr_free(kept);
    wr_session_free(a);
    wr_session_free(b);
    wr_session_free(c);
}

static void a_font_file_is_kept_with_its_checksum(void **state)
{
    (void)state;
    WrError err = { "" };
    WrSession *s = wr_session_new(NULL);
    must_run(s, "table 64x64");
    must_run(s, "text g file=" SANS_FILE " size=40");
    assert_non_null(strstr(wr_session_last_command(s), "sha256="));
    assert_false(wr_session_run(s,
                                "text g file=" SANS_FILE " sha256=00000000000000000000000000000000"
                                "00000000000000000000000000000000",
                                &err));
    must_run(s, "undo");
    WrHash flat = wr_session_hash(s);
    must_run(s, "redo");
    assert_false(wr_hash_equal(flat, wr_session_hash(s)));
    wr_session_free(s);
}

/* Choices made by the program are added to the stored line: checksum of the named font, fallback fonts of single
 * letters. The line then produces the same result on any machine, or an error. */
static void the_kept_line_names_the_fonts_that_wrote_it(void **state)
{
    (void)state;
    static const char hindi[] = "text \"a \xe0\xa4\x95\xe0\xa4\xbf\" font=sans size=30";
    WrError err = { "" };
    WrSession *s = wr_session_new(NULL), *again = wr_session_new(NULL);
    must_run(s, "table 64x64");
    must_run(again, "table 64x64");
    must_run(s, hindi);
    char *kept = wr_strdup(wr_session_last_command(s));
    assert_non_null(strstr(kept, " fallback=/"));
    assert_non_null(strstr(kept, " fallback_sha256="));
    assert_non_null(strstr(kept, " sha256="));
    must_run(again, kept);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    assert_string_equal(kept, wr_session_last_command(again));
    static const char *const sums[] = { " fallback_sha256=", " sha256=" };
    for (int i = 0; i < 2; i++) { /* the file has changed */
        char *digit = strstr(kept, sums[i]) + strlen(sums[i]), was = *digit;
        *digit = was == '0' ? '1' : '0';
        assert_false(wr_session_run(again, kept, &err));
        assert_non_null(strstr(err.text, "file has changed"));
        *digit = was;
    }
    must_run(s, "text \xf4\x8f\xbf\xbd font=sans size=30"); /* in no font at all */
    assert_non_null(strstr(wr_session_last_command(s), " missing=sign"));
    wr_free(kept);
    wr_session_free(s);
    wr_session_free(again);
}

static void mistakes_are_told_and_change_nothing(void **state)
{
    (void)state;
    static const char *const lines[][2] = { { "text a file=" WR_SOURCE_DIR "/README.md",
                                              "not a readable font" },
                                            { "text a file=/nonexistent", "/nonexistent" },
                                            { "text a size=0", "above 0" },
                                            { "text a axes=wght=900", "not variable" },
                                            { "text a fallback=/nonexistent", "/nonexistent" },
                                            { "text a missing=perhaps", "borrow" },
                                            { "text a font=gothic", "terminus" },
                                            { "text a points=0.5,0.5", "two different places" },
                                            { "text a around=lattice lattice=0,0", "not both 0" } };
    WrSession *s = wr_session_new(NULL);
    must_run(s, "table 64x64");
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        must_fail(s, lines[i][0], lines[i][1]);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc78_an_empty_text_leaves_every_bit_as_it_was),
        cmocka_unit_test(hc78_new_lines_survive_being_kept),
        cmocka_unit_test(a_font_file_is_kept_with_its_checksum),
        cmocka_unit_test(the_kept_line_names_the_fonts_that_wrote_it),
        cmocka_unit_test(mistakes_are_told_and_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
