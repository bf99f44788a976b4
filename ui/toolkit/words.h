/* words.h - translations of the window's texts. The English text is the key, as in gettext; translations are
   gettext's .mo files, built from ui/words/NAME.po. The C library's locale is not used: numbers, files and commands
   are unchanged, and languages not installed in the system are available. Window thread only. */
#pragma once
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A string that stays valid, or itself without a translation. A translated format has the same arguments: msgfmt
   checks it in the build, and the compiler checks the English one. */
#ifdef __GNUC__
__attribute__((format_arg(1)))
#endif
const char *
wr_words(const char *english);

typedef struct WrLanguage {
    const char *code; /* "de"; "" uses the environment */
    const char *name; /* name in the language itself */
    char mark;        /* decimal mark of shown numbers */
} WrLanguage;
extern const WrLanguage wr_languages[];
extern const int wr_language_count;

/* Choose the language, a row of wr_languages; 0 or an invalid row: from the environment (LANGUAGE, LC_ALL,
   LC_MESSAGES, LANG, in gettext's order). A language with a missing or damaged file is English. Earlier results stay
   valid. */
void wr_words_choose(int language);
/* An error, note or other message (base/message.h), of which each format is looked up, and each value under the context
   "value"; the rest stays English. out: size bytes, at least 1; longer texts are cut at a character. Returns out. */
const char *wr_words_message(const char *message, char *out, size_t size);
#define WR_WORDS_MESSAGE 1200 /* bytes: enough for the longest error */
/* vsnprintf for the window: numbers of the values get the language's decimal mark. format: translated by the caller. */
int wr_words_vprint(char *out, size_t size, const char *format, va_list args);
int wr_words_print(char *out, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Replaces the points of a number by the language's decimal mark, in place; any other text stays. Returns text. */
char *wr_words_number(char *text);
/* The present language: "en" or the code of a translation. */
const char *wr_words_language(void);
/* The first code requested by the environment that is in wr_languages; "en" if none is requested. Each may be
   NULL. */
const char *wr_words_of(const char *language, const char *all, const char *messages,
                        const char *lang);

/* ---- catalogue file ---- */
typedef struct WrCatalogue WrCatalogue;
/* NULL if the bytes are not a complete .mo file in this machine's byte order. They are copied. */
WrCatalogue *wr_catalogue_new(const char *bytes, size_t size);
void wr_catalogue_free(WrCatalogue *catalogue); /* NULL is allowed */
/* NULL: not found */
const char *wr_catalogue_find(const WrCatalogue *catalogue, const char *english);

/* Called for each requested text without a translation, if set; for tests. */
extern void (*wr_words_missed)(const char *english);
extern void (*wr_words_requested)(const char *english); /* called for each requested text */

#ifdef __cplusplus
}
#endif
