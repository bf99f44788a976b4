/* Reader of .mo files as in GNU gettext's manual ("The Format of GNU MO Files"): a header of 32-bit words, two tables
   of (length, offset) for the originals, which are sorted, and for the translations; each text ends with a zero. */
#include "ui/toolkit/words.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/enum_rows.h"
#include "base/text.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAGIC 0x950412deu
#define MAX_MOST (8u << 20) /* size limit of a file */

const WrLanguage wr_languages[] = { { "", "As the system", '.' },
                                    { "en", "English", '.' },
                                    { "de", "Deutsch", ',' },
                                    { "fr",
                                      "Fran\xc3\xa7"
                                      "ais",
                                      ',' } };
const int wr_language_count = WR_LENGTH(wr_languages);

void (*wr_words_missed)(const char *english);
void (*wr_words_requested)(const char *english);

/* ---- catalogue file ---- */

struct WrCatalogue {
    char *bytes; /* owned */
    uint32_t count, originals, translations;
};

static uint32_t word_at(const char *bytes, size_t place)
{
    uint32_t word;
    memcpy(&word, bytes + place, sizeof word);
    return word;
}

/* Check that a table of texts is inside the file, and that each text is inside and zero-terminated. */
static bool is_table(const char *bytes, size_t size, uint32_t at, uint32_t count)
{
    if (at > size || (size_t)count * 8 > size - at) return false;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t length = word_at(bytes, at + (size_t)i * 8);
        const uint32_t place = word_at(bytes, at + (size_t)i * 8 + 4);
        if (place >= size || length >= size - place || bytes[place + length] != '\0') return false;
    }
    return true;
}

WrCatalogue *wr_catalogue_new(const char *bytes, size_t size)
{
    if (size < 28 || word_at(bytes, 0) != MAGIC || word_at(bytes, 4) >> 16 > 1) return NULL;
    const uint32_t count = word_at(bytes, 8), from = word_at(bytes, 12), to = word_at(bytes, 16);
    if (!is_table(bytes, size, from, count) || !is_table(bytes, size, to, count)) return NULL;
    WrCatalogue *catalogue = wr_alloc(1, sizeof *catalogue);
    *catalogue = (WrCatalogue){ wr_alloc(size, 1), count, from, to };
    memcpy(catalogue->bytes, bytes, size);
    return catalogue;
}

void wr_catalogue_free(WrCatalogue *catalogue)
{
    if (!catalogue) return;
    wr_free(catalogue->bytes);
    wr_free(catalogue);
}

static const char *text_at(const WrCatalogue *c, uint32_t table, uint32_t i)
{
    return c->bytes + word_at(c->bytes, table + (size_t)i * 8 + 4);
}

const char *wr_catalogue_find(const WrCatalogue *c, const char *english)
{
    if (!english[0]) return NULL; /* it is the header of the file */
    uint32_t low = 0, high = c->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const int order = strcmp(english, text_at(c, c->originals, middle));
        if (order == 0) {
            const char *found = text_at(c, c->translations, middle);
            return found[0] ? found : NULL;
        }
        if (order < 0) high = middle;
        else low = middle + 1;
    }
    return NULL;
}

/* ---- the environment ---- */

/* "de_AT.UTF-8" is German as well. */
static const char *known(const char *name, size_t length)
{
    size_t bare = 0;
    while (bare < length && name[bare] != '_' && name[bare] != '.' && name[bare] != '@') bare++;
    for (int i = 1; i < wr_language_count; i++)
        if (strlen(wr_languages[i].code) == bare && strncmp(name, wr_languages[i].code, bare) == 0)
            return wr_languages[i].code;
    return NULL;
}

static const char *said(const char *text)
{
    return text && text[0] ? text : NULL;
}

const char *wr_words_of(const char *language, const char *all, const char *messages,
                        const char *lang)
{
    const char *locale = said(all) ? all : said(messages) ? messages : said(lang);
    const bool plain = locale && (strcmp(locale, "C") == 0 || strcmp(locale, "POSIX") == 0);
    if (plain) return "en"; /* LANGUAGE is ignored in the C locale */
    for (const char *at = said(language); at && *at;) {
        const size_t length = strcspn(at, ":");
        const char *found = known(at, length);
        if (found) return found;
        at += length + (at[length] == ':');
    }
    const char *found = locale ? known(locale, strlen(locale)) : NULL;
    return found ? found : "en";
}

/* ---- present language ---- */

static struct {
    WrCatalogue *read[WR_LENGTH(wr_languages)]; /* never freed: their texts may be in use */
    bool tried[WR_LENGTH(wr_languages)];
    int now; /* row of wr_languages; 0: English */
} spoken;

/* From the build folder beside the program, or from its installation. */
static WrCatalogue *read_file(const char *code)
{
    static const char *const places[] = { "locale", "../share/locale" };
    WrCatalogue *catalogue = NULL;
    char *folder = wr_program_folder();
    for (size_t i = 0; folder && !catalogue && i < WR_LENGTH(places); i++) {
        WrText path = { 0 };
        WrError ignored;
        char *bytes;
        size_t size;
        wr_text_addf(&path, "%s/%s/%s/LC_MESSAGES/wrinkle.mo", folder, places[i], code);
        if (wr_file_read(wr_text_get(&path), MAX_MOST, &bytes, &size, &ignored)) {
            catalogue = wr_catalogue_new(bytes, size);
            wr_free(bytes);
        }
        wr_text_fini(&path);
    }
    wr_free(folder);
    return catalogue;
}

void wr_words_choose(int language)
{
    const bool named = language > 0 && language < wr_language_count;
    const char *code = wr_languages[named ? language : 0].code;
    if (!named)
        code = wr_words_of(getenv("LANGUAGE"), getenv("LC_ALL"), getenv("LC_MESSAGES"),
                           getenv("LANG"));
    int wanted = 0;
    for (int i = 1; i < wr_language_count; i++)
        if (strcmp(code, wr_languages[i].code) == 0 && strcmp(code, "en") != 0) wanted = i;
    if (wanted && !spoken.tried[wanted]) {
        spoken.tried[wanted] = true;
        spoken.read[wanted] = read_file(code);
    }
    spoken.now = wanted && spoken.read[wanted] ? wanted : 0;
}

const char *wr_words_language(void)
{
    return spoken.now ? wr_languages[spoken.now].code : "en";
}

/* NULL: no translation */
static const char *find(const char *english)
{
    return spoken.now ? wr_catalogue_find(spoken.read[spoken.now], english) : NULL;
}

static const char *print_format(const char *english)
{
    const char *found = find(english);
    return found ? found : english;
}

/* In gettext's files, a context and the byte 4 are before the text. */
static const char *print_value(const char *english)
{
    char key[WR_WORDS_MESSAGE];
    snprintf(key, sizeof key, "value\4%s", english);
    const char *found = find(key);
    return found ? found : english;
}

const char *wr_words_message(const char *message, char *out, size_t size)
{
    static const WrMessageWords words = { print_format, print_value };
    const char *whole = find(message); /* a text that no format wrote */
    return wr_message_print(whole ? whole : message, &words, out, size);
}

char *wr_words_number(char *text)
{
    char *point = strchr(text, '.');
    const bool number = text[strspn(text, " +-0123456789.eE")] == '\0';
    if (point && number && !strchr(point + 1, '.')) *point = wr_languages[spoken.now].mark;
    return text;
}

static const char *itself(const char *format)
{
    return format;
}

static const char *print_number(const char *value)
{
    static char text[64];
    const size_t length = strlen(value);
    if (length >= sizeof text) return value;
    memcpy(text, value, length + 1);
    return wr_words_number(text);
}

int wr_words_vprint(char *out, size_t size, const char *format, va_list args)
{
    static const WrMessageWords numbers = { itself, print_number };
    char message[WR_WORDS_MESSAGE];
    if (wr_languages[spoken.now].mark == '.') return vsnprintf(out, size, format, args);
    wr_message_format(out, size, message, sizeof message, format, args);
    if (message[0]) wr_message_print(message, &numbers, out, size);
    return (int)strlen(out);
}

int wr_words_print(char *out, size_t size, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    const int length = wr_words_vprint(out, size, format, args);
    va_end(args);
    return length;
}

const char *wr_words(const char *english)
{
    if (wr_words_requested && english) wr_words_requested(english);
    if (!spoken.now || !english) return english;
    const char *found = find(english);
    if (!found && wr_words_missed) wr_words_missed(english);
    return found ? found : english;
}
