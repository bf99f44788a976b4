/* words.h - the window's words in the user's language.
   The English text itself is the key, as with gettext; translations are its .mo files, made at the build from
   ui/words/NAME.po. Nothing here asks the C library's locale: numbers, files and commands stay as they are, and a
   language can be chosen that the system was not made ready for. One thread, the window's. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A text that stays where it is becomes itself where it has no translation. A translation of a format takes the same
   arguments: msgfmt looks at the build, and the compiler at the English one. */
#ifdef __GNUC__
__attribute__((format_arg(1)))
#endif
const char *
wr_words(const char *english);

typedef struct WrLanguage {
    const char *code; /* "de"; "" follows the environment */
    const char *name; /* in the language itself */
} WrLanguage;
extern const WrLanguage wr_languages[];
extern const int wr_language_count;

/* What to speak from now on, a row of wr_languages; 0 and what is none: as the environment says (LANGUAGE, LC_ALL,
   LC_MESSAGES, LANG, in gettext's way). A language without a file, or with a damaged one, is English. Texts given before stay where they are. */
void wr_words_choose(int language);
/* The one that is spoken: "en" or the code of a translation that was found. */
const char *wr_words_language(void);
/* The codes that the environment asks for, the first one that is in wr_languages; "en" where it asks for none. Each may
   be NULL. */
const char *wr_words_of(const char *language, const char *all, const char *messages,
                        const char *lang);

/* ---- a file of words ---- */
typedef struct WrCatalogue WrCatalogue;
/* NULL where the bytes are not a whole .mo file of this machine's order. They are copied. */
WrCatalogue *wr_catalogue_new(const char *bytes, size_t size);
void wr_catalogue_free(WrCatalogue *catalogue); /* NULL is fine */
const char *wr_catalogue_find(const WrCatalogue *catalogue,
                              const char *english); /* NULL: it has none */

/* Told of each text that was asked for and has no translation, while it is set; for tests. */
extern void (*wr_words_missed)(const char *english);
extern void (*wr_words_asked)(const char *english); /* of each that was asked for */

#ifdef __cplusplus
}
#endif
