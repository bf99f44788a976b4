/* Messages that keep their format and values, and errors that carry them. */
#include "test.h"

#include "base/error.h"
#include "base/message.h"
#include "base/text.h"

#include <inttypes.h>
#include <stdarg.h>
#include <string.h>

/* Each text equals the output of the C library's printf, and the message reads as that text. */
static void same(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void same(const char *format, ...)
{
    char wanted[2048], plain[2048], message[4096], said[2048];
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    vsnprintf(wanted, sizeof wanted, format, args);
    wr_message_format(plain, sizeof plain, message, sizeof message, format, again);
    va_end(again);
    va_end(args);
    assert_string_equal(plain, wanted);
    assert_string_not_equal(message, "");
    assert_string_equal(wr_message_print(message, NULL, said, sizeof said), wanted);
}

static void text_is_that_of_printf(void **state)
{
    (void)state;
    static const char no_end[3] = { 'a', 'b', 'c' };
    same("nothing");
    same("100 %% of %d %i %u", -3, 4, 5u);
    same("%5d|%-5d|%05d|%+d|% d|%.3d", 7, 7, 7, 7, 7, 7);
    same("%*d|%-*d|%.*f", 6, 1, 6, 2, 3, 0.5);
    same("%ld %lu %lld %llu %zu %td", -1L, 2ul, -3ll, 4ull, (size_t)5, (ptrdiff_t)-6);
    same("%" PRId64 " %" PRIu64 " %" PRIx64, INT64_MIN, UINT64_MAX, (uint64_t)255);
    same("%x %X %#x %o %02x", 255u, 255u, 255u, 8u, 10u);
    same("%g %.9g %.17g %.0f %.1f %e %a", 0.1, 1.0 / 3, 0.1, 2.5, 1e300, 1e-300, 0.75);
    same("%f", 1.7e308);
    same("%c%c", 'x', 'y');
    same("'%s' '%.2s' '%10s' '%-10s' '%.3s'", "word", "word", "word", "word", no_end);
    same("%.*s|%.*s", 2, "word", -1, "word");
    same("%s", "alone");
    same("%s%s", "", "");
}

/* A conversion that is not handled: the text is right, and there is no message. */
static void unknown_conversion_has_no_message(void **state)
{
    (void)state;
    char text[64];
    WrError err;
    wr_fail(&err, "%hd of %s", (short)3, "four");
    assert_string_equal(err.text, "3 of four");
    assert_ptr_equal(wr_error_message(&err), err.text);
    wr_fail(&err, "%Lg", 0.5L);
    assert_string_equal(wr_message_print(wr_error_message(&err), NULL, text, sizeof text), "0.5");
}

static const char *german(const char *english)
{
    static const char *const texts[][2] = {
        { "layer %d: must be %s", "muss %2$s sein: Ebene %1$d" },
        { "%d channel%s", "%d Kan\xc3\xa4le%.0s" },
        { "at least %g", "mindestens %g" },
        { "a text", "ein Text" },
        { "%s: cannot be read: %s", "%s: nicht lesbar: %s" },
        { "%s: cannot be read: %.7s", "%s: nicht lesbar: %.7s" },
        { "100 %% of %s", "100 %% von %s" },
        { "line %d: ", "Zeile %d: " },
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (strcmp(texts[i][0], english) == 0) return texts[i][1];
    return english;
}

static const char *german_value(const char *english)
{
    return strcmp(english, "Is a directory") == 0 ? "ist ein Ordner" : english;
}

static const WrMessageWords words = { german, german_value };

static void says(const WrError *err, const char *wanted)
{
    char said[1024];
    assert_string_equal(wr_message_print(wr_error_message(err), &words, said, sizeof said), wanted);
}

static void translations_order_and_omit_values(void **state)
{
    (void)state;
    WrError err;
    wr_fail(&err, "layer %d: must be %s", 3, "1..2");
    assert_string_equal(err.text, "layer 3: must be 1..2");
    says(&err, "muss 1..2 sein: Ebene 3");
    wr_fail(&err, "%d channel%s", 2, "s");
    says(&err, "2 Kan\xc3\xa4le");
    wr_fail(&err, "100 %% of %s", "%d");
    says(&err, "100 % von %d");
    wr_fail(&err, "no translation of %d", 3);
    says(&err, "no translation of 3");
    /* Only a whole value is looked up among the values, and no value among the formats. */
    wr_fail(&err, "%s: cannot be read: %s", "a text", "Is a directory");
    says(&err, "a text: nicht lesbar: ist ein Ordner");
}

static void inner_errors_and_parts_are_translated(void **state)
{
    (void)state;
    WrError inner, err, copy;
    WrText right = { 0 };
    wr_message_addf(&right, "at least %g", 0.5);
    wr_text_add(&right, ", ");
    wr_text_add(&right, WR_MESSAGE("a text"));
    wr_fail(&inner, "layer %d: must be %s", 3, wr_text_get(&right));
    wr_text_fini(&right);
    assert_string_equal(inner.text, "layer 3: must be at least 0.5, a text");
    wr_fail(&err, "%s: cannot be read: %s", "a.png", wr_error_message(&inner));
    assert_string_equal(err.text, "a.png: cannot be read: layer 3: must be at least 0.5, a text");
    wr_error_prefix(&err, "line %d: ", 7);
    assert_string_equal(err.text,
                        "line 7: a.png: cannot be read: layer 3: must be at least 0.5, a text");
    copy = err;
    memset(&err, 'x', sizeof err);
    says(&copy, "Zeile 7: a.png: nicht lesbar: muss mindestens 0.5, ein Text sein: Ebene 3");
    /* An inner error as plain text: the outer one is translated. */
    wr_fail(&err, "%s: cannot be read: %s", "a.png", inner.text);
    says(&err, "a.png: nicht lesbar: layer 3: must be at least 0.5, a text");
    wr_fail(&err, "%s: cannot be read: %.7s", "a.png", inner.text);
    assert_string_equal(err.text, "a.png: cannot be read: layer 3");
    says(&err, "a.png: nicht lesbar: layer 3");
    /* A text that was changed by hand has no message. */
    strcpy(copy.text + 4, " eight");
    assert_ptr_equal(wr_error_message(&copy), copy.text);
}

static void long_errors_are_cut_at_characters(void **state)
{
    (void)state;
    char longest[3000], small[40];
    WrError err;
    for (size_t i = 0; i + 2 < sizeof longest; i += 2) memcpy(longest + i, "\xc3\xa4", 3);
    for (int n = 0; n < 4; n++) {
        wr_fail(&err, "%.*s%s", n, "abc", longest);
        const size_t length = strlen(err.text);
        assert_true(length == WR_ERROR_TEXT - 1 || length == WR_ERROR_TEXT - 2);
        assert_int_equal((length - (size_t)(n < 3 ? n : 3)) % 2, 0);
        assert_ptr_equal(wr_error_message(&err), err.text);
        wr_error_prefix(&err, "%s: ", "a");
        assert_memory_equal(err.text, "a: ", 3);
        assert_true(strlen(err.text) < WR_ERROR_TEXT);
    }
    wr_fail(&err, "layer %d: must be %s", 3, "\xc3\xa4\xc3\xa4");
    for (size_t size = 1; size < sizeof small; size++) {
        wr_message_print(wr_error_message(&err), &words, small, size);
        assert_true(strlen(small) < size);
        assert_memory_equal(small, "muss \xc3\xa4\xc3\xa4 sein: Ebene 3", strlen(small));
        assert_true(size < 6 || size > 9 || strlen(small) % 2 == 1); /* whole letters */
    }
}

/* A message may come from another process or be cut by a buffer. */
static void damaged_messages_are_read_within_their_bytes(void **state)
{
    (void)state;
    WrError inner, err;
    char out[64];
    wr_fail(&inner, "layer %d: must be %s", 3, "1..2");
    wr_fail(&err, "%s: cannot be read: %s", "a.png", wr_error_message(&inner));
    const char *whole = wr_error_message(&err);
    TestRandom random = { 5 };
    static const char bytes[] = "\2\3\37%s$1*.d";
    for (int i = 0; i < 20000; i++) {
        char *damaged = strndup(whole, (size_t)(test_random_u64(&random) % (strlen(whole) + 1)));
        for (int k = 0; k < 4 && damaged[0]; k++)
            damaged[test_random_u64(&random) % strlen(damaged)] =
                bytes[test_random_u64(&random) % (sizeof bytes - 1)];
        wr_message_print(damaged, &words, out, sizeof out);
        assert_true(strlen(out) < sizeof out);
        assert_null(strpbrk(out, WR_MESSAGE_MARKS));
        wr_fail(&inner, "%s: %s", "again", damaged);
        assert_null(strpbrk(inner.text, WR_MESSAGE_MARKS));
        wr_message_print(wr_error_message(&inner), &words, out, sizeof out);
        free(damaged);
    }
    /* No byte beyond the precision is read. */
    static const char no_end[] = { 'a', '\2', 'b', 'c', '\3' };
    wr_fail(&err, "%.*s", (int)sizeof no_end, no_end);
    assert_string_equal(err.text, "abc");
    wr_message_print("cut \2layer %d: must be %s\37"
                     "3",
                     &words, out, sizeof out);
    assert_string_equal(out, "cut muss %2$s sein: Ebene 3");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_that_of_printf),
        cmocka_unit_test(unknown_conversion_has_no_message),
        cmocka_unit_test(translations_order_and_omit_values),
        cmocka_unit_test(inner_errors_and_parts_are_translated),
        cmocka_unit_test(long_errors_are_cut_at_characters),
        cmocka_unit_test(damaged_messages_are_read_within_their_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
