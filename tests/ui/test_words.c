/* Translation catalogues, valid and damaged, and the language chosen from the environment. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "ui/toolkit/words.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define TEXTS 5

/* Sorted, as required by the format; the empty one is the header. */
static const char *const from[TEXTS] = { "", "%d of %s", "Brush", "Height", "Layer" };
static const char *const to[TEXTS] = { "Language: xx\n", "%d von %s", "Pinsel", "H\xc3\xb6he", "" };

static void put(char *bytes, size_t at, uint32_t word)
{
    memcpy(bytes + at, &word, sizeof word);
}

/* A file of the texts above, as in GNU gettext's manual; returns its size. */
static size_t written(char bytes[512])
{
    size_t end = 28 + 2 * 8 * TEXTS;
    memset(bytes, 0, 512);
    put(bytes, 0, 0x950412deu);
    put(bytes, 8, TEXTS);
    put(bytes, 12, 28);
    put(bytes, 16, 28 + 8 * TEXTS);
    for (int table = 0; table < 2; table++)
        for (int i = 0; i < TEXTS; i++) {
            const char *text = table ? to[i] : from[i];
            const size_t row = 28 + 8 * (size_t)(table * TEXTS + i), length = strlen(text);
            put(bytes, row, (uint32_t)length);
            put(bytes, row + 4, (uint32_t)end);
            memcpy(bytes + end, text, length + 1);
            end += length + 1;
        }
    return end;
}

static void texts_of_a_file_are_found_and_no_others(void **state)
{
    (void)state;
    char bytes[512];
    WrCatalogue *c = wr_catalogue_new(bytes, written(bytes));
    assert_non_null(c);
    memset(bytes, 'x', sizeof bytes); /* it has its own copy */
    assert_string_equal(wr_catalogue_find(c, "Height"), "H\xc3\xb6he");
    assert_string_equal(wr_catalogue_find(c, "Brush"), "Pinsel");
    assert_string_equal(wr_catalogue_find(c, "%d of %s"), "%d von %s");
    assert_null(wr_catalogue_find(c, "Layer")); /* not translated */
    assert_null(wr_catalogue_find(c, ""));
    assert_null(wr_catalogue_find(c, "Brushes"));
    assert_null(wr_catalogue_find(c, "A"));
    assert_null(wr_catalogue_find(c, "Zoom"));
    wr_catalogue_free(c);
}

/* Look-ups in every accepted file: sanitizers detect reads outside. */
static bool survives(const char *bytes, size_t size)
{
    char *exact = malloc(size ? size : 1);
    memcpy(exact, bytes, size);
    WrCatalogue *c = wr_catalogue_new(exact, size);
    free(exact);
    for (int i = 0; c && i < TEXTS; i++) {
        const char *found = wr_catalogue_find(c, from[i]);
        if (found) assert_true(strlen(found) < 512);
    }
    wr_catalogue_free(c);
    return c != NULL;
}

static void a_file_that_ends_early_is_refused(void **state)
{
    (void)state;
    char bytes[512];
    const size_t size = written(bytes);
    assert_true(survives(bytes, size));
    for (size_t n = 0; n < size; n++) assert_false(survives(bytes, n));
}

static void a_file_with_any_byte_changed_is_refused_or_read_within_itself(void **state)
{
    (void)state;
    char bytes[512];
    const size_t size = written(bytes);
    int refused = 0;
    for (size_t at = 0; at < size; at++)
        for (int bit = 0; bit < 8; bit++) {
            bytes[at] = (char)(bytes[at] ^ 1 << bit);
            refused += !survives(bytes, size);
            bytes[at] = (char)(bytes[at] ^ 1 << bit);
        }
    assert_true(refused > 8 * 4); /* at least the magic number */
}

static void lengths_that_run_over_the_end_of_numbers_are_refused(void **state)
{
    (void)state;
    static const uint32_t wrong[] = { 0xffffffffu, 0x7fffffffu, 0x20000001u, 0xfffffff8u, 512 };
    static const size_t places[] = { 8, 12, 16, 28, 32, 68, 72 };
    char bytes[512];
    for (size_t p = 0; p < 7; p++)
        for (size_t w = 0; w < 5; w++) {
            const size_t size = written(bytes);
            put(bytes, places[p], wrong[w]);
            assert_false(survives(bytes, size));
        }
}

static void the_environment_chooses_as_gettext_does(void **state)
{
    (void)state;
    static const struct {
        const char *language, *all, *messages, *lang, *wanted;
    } rows[] = {
        { NULL, NULL, NULL, NULL, "en" },
        { NULL, NULL, NULL, "de_DE.UTF-8", "de" },
        { NULL, NULL, "de_AT", "fr_FR", "de" },
        { NULL, "en_GB.UTF-8", "de_DE", "de_DE", "en" },
        { "de", NULL, NULL, NULL, "de" },
        { "fr:de:en", NULL, NULL, "de_DE.UTF-8", "fr" },
        { "eo:de:en", NULL, NULL, "fr_FR.UTF-8", "de" },
        { NULL, NULL, NULL, "fr_CA.UTF-8", "fr" },
        { "en:de", NULL, NULL, "de_DE.UTF-8", "en" },
        { "", NULL, NULL, "de_CH@euro", "de" },
        { "de", "C", NULL, "de_DE", "en" }, /* the plain locale is English for any LANGUAGE */
        { "de", "", "POSIX", "de_DE", "en" },
        { "de", "C.UTF-8", NULL, NULL, "de" },
        { "eo", NULL, NULL, "it_IT", "en" },     /* not available */
        { "deutsch::", NULL, NULL, NULL, "en" }, /* only a prefix */
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        assert_string_equal(
            wr_words_of(rows[i].language, rows[i].all, rows[i].messages, rows[i].lang),
            rows[i].wanted);
}

static void english_is_itself(void **state)
{
    (void)state;
    const char *text = "Brush";
    wr_words_choose(1);
    assert_string_equal(wr_words_language(), "en");
    assert_ptr_equal(wr_words(text), text);
    wr_words_choose(-7); /* no row: the environment's */
    wr_words_choose(1000);
}

static void every_language_of_the_table_has_its_file(void **state)
{
    (void)state;
    int without = 0;
    for (int i = 2; i < wr_language_count; i++) {
        wr_words_choose(i);
        without += strcmp(wr_words_language(), "en") == 0;
        if (without == 0) assert_string_equal(wr_words_language(), wr_languages[i].code);
    }
    wr_words_choose(1);
    if (without == wr_language_count - 2) skip(); /* a build without msgfmt */
    assert_int_equal(without, 0);
}

/* Formats of the program whose German is known, by the catalogue of the build. */
static void messages_are_said_by_their_formats(void **state)
{
    (void)state;
    char said[WR_WORDS_MESSAGE], small[24];
    WrError inner, err;
    wr_words_choose(2);
    if (strcmp(wr_words_language(), "de") != 0) skip(); /* a build without msgfmt */
    wr_fail(&inner, "no layer is called \"%s\": must be a name or 1..%d", "top: x", 3);
    assert_string_equal(wr_words_message(wr_error_message(&inner), said, sizeof said),
                        "keine Ebene hei\xc3\x9ft \"top: x\": muss ein Name sein oder 1..3");
    wr_fail(&err, "%s: %s", "nothing to undo", wr_error_message(&inner));
    assert_string_equal(
        wr_words_message(wr_error_message(&err), said, sizeof said),
        "nothing to undo: keine Ebene hei\xc3\x9ft \"top: x\": muss ein Name sein oder 1..3");
    /* Values are looked up among values alone: a layer's name is no text of the window. */
    wr_fail(&err, "%s: %s", "Brush", "No such file or directory");
    assert_string_equal(wr_words_message(wr_error_message(&err), said, sizeof said),
                        "Brush: Datei oder Ordner nicht gefunden");
    static const char *const same[] = { ": must be ", "a b c: d", "100 %s of %d", "" };
    for (int i = 0; i < WR_LENGTH(same); i++)
        assert_string_equal(wr_words_message(same[i], said, sizeof said), same[i]);
    /* Truncated between letters, at any size. */
    static const char german[] = "nichts r\xc3\xbc"
                                 "ckg\xc3\xa4ngig zu machen";
    wr_fail(&err, "nothing to undo");
    for (size_t size = 1; size <= sizeof small; size++) {
        memset(small, 'x', sizeof small);
        wr_words_message(wr_error_message(&err), small, size);
        const size_t length = strlen(small);
        assert_true(length < size && length + 2 >= size);
        assert_memory_equal(small, german, length);
        assert_true(((unsigned char)german[length] & 0xc0) != 0x80);
    }
    wr_words_choose(1);
    assert_string_equal(wr_words_message(wr_error_message(&inner), said, sizeof said), inner.text);
}

static void numbers_of_texts_have_the_mark_of_the_language(void **state)
{
    (void)state;
    static const char *const wanted[] = { NULL, "0.50 of 2.5 MB, x.5 and 3: 1..4 -1e-05",
                                          "0,50 of 2,5 MB, x.5 and 3: 1..4 -1e-05",
                                          "0,50 of 2,5 MB, x.5 and 3: 1..4 -1e-05" };
    char text[80], small[4];
    for (int i = 1; i < WR_LENGTH(wanted); i++) {
        wr_words_choose(i);
        if (strcmp(wr_words_language(), wr_languages[i].code) != 0) continue; /* without msgfmt */
        const int length = wr_words_print(text, sizeof text, "%.2f of %.3g MB, %s and %d: 1..4 %g",
                                          0.5, 2.5, "x.5", 3, -1e-5);
        assert_string_equal(text, wanted[i]);
        assert_int_equal(length, strlen(text));
        wr_words_print(small, sizeof small, "%.2f", 0.25);
        assert_string_equal(small, wr_languages[i].mark == ',' ? "0,2" : "0.2");
        snprintf(text, sizeof text, "1.2.3");
        assert_string_equal(wr_words_number(text), "1.2.3");
        snprintf(text, sizeof text, "+12.75");
        assert_string_equal(wr_words_number(text),
                            wr_languages[i].mark == ',' ? "+12,75" : "+12.75");
    }
    wr_words_choose(1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts_of_a_file_are_found_and_no_others),
        cmocka_unit_test(a_file_that_ends_early_is_refused),
        cmocka_unit_test(a_file_with_any_byte_changed_is_refused_or_read_within_itself),
        cmocka_unit_test(lengths_that_run_over_the_end_of_numbers_are_refused),
        cmocka_unit_test(the_environment_chooses_as_gettext_does),
        cmocka_unit_test(english_is_itself),
        cmocka_unit_test(numbers_of_texts_have_the_mark_of_the_language),
        cmocka_unit_test(every_language_of_the_table_has_its_file),
        cmocka_unit_test(messages_are_said_by_their_formats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
