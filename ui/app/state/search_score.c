#include "ui/app/state/search_score.h"

#include "base/text.h"

#include <SDL.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

static bool is_letter(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
           (unsigned char)c >= 0x80;
}

/* Score of one word: 0 no match, 1 inside a word, 2 at the start of a word, 4 at the start of the label. */
static int word_score(const char *label, const char *word, size_t length)
{
    int best = 0;
    for (const char *at = label; *at; at++) {
        if (SDL_strncasecmp(at, word, length) != 0) continue;
        int score = at == label ? 4 : !is_letter(at[-1]) ? 2 : 1;
        best = score > best ? score : best;
    }
    return best;
}

int wr_search_score(const char *label, const char *query)
{
    int sum = 1;
    for (const char *at = query; *at;) {
        size_t length = strcspn(at, " ");
        if (length > 0) {
            int score = word_score(label, at, length);
            if (score == 0) return 0;
            sum += score;
        }
        at += length + (at[length] == ' ');
    }
    return sum;
}

/* ---- the search of everything ---- */

/* Latin letters of two bytes without their accents; sz, ae and oe are two letters. */
static const char *plain_letter(unsigned char lead, unsigned char next)
{
    static const char *const c3[64] = { "a", "a", "a", "a", "a", "a",  "ae", "c", "e", "e",  "e",
                                        "e", "i", "i", "i", "i", "d",  "n",  "o", "o", "o",  "o",
                                        "o", " ", "o", "u", "u", "u",  "u",  "y", "t", "ss", "a",
                                        "a", "a", "a", "a", "a", "ae", "c",  "e", "e", "e",  "e",
                                        "i", "i", "i", "i", "d", "n",  "o",  "o", "o", "o",  "o",
                                        " ", "o", "u", "u", "u", "u",  "y",  "t", "y" };
    if (lead == 0xc5 && (next == 0x92 || next == 0x93)) return "oe";
    return lead == 0xc3 && next >= 0x80 && next < 0xc0 ? c3[next - 0x80] : NULL;
}

/* Bytes of an apostrophe, straight or curly; 0: none. */
static size_t apostrophe(const unsigned char *c)
{
    if (*c == '\'') return 1;
    return c[0] == 0xe2 && c[1] == 0x80 && c[2] == 0x99 ? 3 : 0;
}

void wr_search_fold(const char *text, WrText *out)
{
    bool gap = false;
    const size_t start = out->length;
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        const char *plain = plain_letter(c[0], c[1]);
        const char one[2] = { (char)(*c >= 'A' && *c <= 'Z' ? *c + 32 : *c), '\0' };
        if (*c == ',') wr_text_add(out, ",");
        const size_t mark = apostrophe(c);
        if (mark > 0) { /* "brush's" is one word, "d'images" are two */
            gap = gap || out->length < start + 2 || strchr(" ,", out->data[out->length - 2]);
            c += mark - 1;
            continue;
        }
        const bool space = c[0] == 0xc2 && c[1] == 0xa0; /* that does not break */
        if (space || (!plain && !is_letter((char)*c))) {
            gap = true;
            c += space;
            continue;
        }
        if (gap && out->length > start && out->data[out->length - 1] != ',') wr_text_add(out, " ");
        gap = false;
        wr_text_add(out, plain ? plain : one);
        if (plain) c++;
    }
}

static bool is_filler(const char *word)
{
    static const char *const fillers[] = {
        "a",  "an", "the", "of",  "to",  "for",  "with", "in",   "on",   "and", "or", "how",
        "do", "i",  "my",  "is",  "der", "die",  "das",  "ein",  "und",  "wie", "zu", "mit",
        "l",  "le", "la",  "les", "un",  "une",  "d",    "de",   "du",   "des", "au", "aux",
        "en", "et", "ou",  "par", "sur", "pour", "avec", "dans", "comme"
    };
    for (size_t i = 0; i < sizeof fillers / sizeof *fillers; i++)
        if (strcmp(word, fillers[i]) == 0) return true;
    return false;
}

static void add_words(const char *folded, bool all, WrSearchQuery *query)
{
    for (const char *at = folded; *at && query->count < WR_SEARCH_WORDS;) {
        const size_t length = strcspn(at, " ,");
        char *word = query->words[query->count];
        if (length > 0 && length < WR_SEARCH_LETTERS) {
            memcpy(word, at, length);
            word[length] = '\0';
            if (all || !is_filler(word)) query->count++;
        }
        at += length + (at[length] != '\0');
    }
}

void wr_search_parse(const char *text, WrSearchQuery *query)
{
    WrText folded = { 0 };
    memset(query, 0, sizeof *query);
    wr_search_fold(text, &folded);
    for (const char *c = wr_text_get(&folded);
         *c && strlen(query->joined) + 1 < sizeof query->joined; c++)
        if (*c != ' ' && *c != ',') strncat(query->joined, c, 1);
    add_words(wr_text_get(&folded), false, query);
    if (query->count == 0) add_words(wr_text_get(&folded), true, query);
    wr_text_fini(&folded);
}

/* True if the words differ only in their endings, such as those of plurals. */
static bool same_stem(const char *a, size_t a_length, const char *b, size_t b_length)
{
    static const char *const ends[] = { "",   "s", "es",  "e",   "en", "n",  "er",
                                        "ed", "d", "ing", "ern", "x",  "ee", "ees" };
    size_t common = 0;
    int known = 0;
    while (common < a_length && common < b_length && a[common] == b[common]) common++;
    if (common < 3) return false;
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        known += strlen(ends[i]) == a_length - common &&
                 strncmp(a + common, ends[i], a_length - common) == 0;
        known += strlen(ends[i]) == b_length - common &&
                 strncmp(b + common, ends[i], b_length - common) == 0;
    }
    return known == 2;
}

static unsigned letters_of(const char *word)
{
    unsigned set = 0;
    for (; *word; word++) set |= 1u << (*word & 31);
    return set;
}

/* True if more letters occur in only one of the words than so many edits explain. */
static bool differs(const char *a, const char *b, int edits)
{
    int count = 0;
    for (unsigned set = letters_of(a) ^ letters_of(b); set; set &= set - 1) count++;
    return count > 2 * edits;
}

/* 0..100 for a typed word and a word of an entry. */
static int match(const char *typed, size_t length, const char *word, size_t whole, bool typos)
{
    char copy[WR_SEARCH_LETTERS];
    if (whole == length && memcmp(typed, word, length) == 0) return 100;
    if (same_stem(typed, length, word, whole)) return 92;
    if (whole > length && memcmp(typed, word, length) == 0) return 65 + (int)(25 * length / whole);
    if (whole >= sizeof copy) return 0;
    memcpy(copy, word, whole);
    copy[whole] = '\0';
    if (length >= 4 && strstr(copy, typed)) return 50 + (int)(10 * length / whole);
    const int allowed = length >= 8 ? 2 : length >= 4 ? 1 : 0;
    if (!typos || allowed == 0) return 0;
    const int more = (int)whole - (int)length;
    if (more >= -allowed && more <= allowed && !differs(typed, copy, allowed)) {
        const int distance = wr_word_distance(typed, copy);
        if (distance <= allowed) return 62 - 10 * distance;
    }
    if (length < 5 || more <= 0 || typed[0] != copy[0]) return 0;
    copy[length] = '\0'; /* a mistake in a word that is not typed to its end */
    return !differs(typed, copy, 1) && wr_word_distance(typed, copy) <= 1 ? 40 : 0;
}

/* The best match of a typed word in a text; covered: the matched word counts for the share of the text. */
static int match_text(const char *typed, const char *text, bool typos)
{
    const size_t length = strlen(typed);
    int best = 0;
    for (const char *at = text; *at && best < 100;) {
        const size_t whole = strcspn(at, " ,");
        const int score = whole > 0 ? match(typed, length, at, whole, typos) : 0;
        if (score > best) best = score;
        at += whole + (at[whole] != '\0');
    }
    return best;
}

/* 60 if one of the alternatives is the query, written in one word or in several; 15 if it begins with it. */
static int phrase_bonus(const char *joined, const char *text)
{
    int best = 0;
    for (const char *at = text; *at;) {
        const size_t length = strcspn(at, ",");
        const char *from = at, *end = at + length, *query = joined;
        while (from < end && *query && (*from == ' ' || *from == *query)) {
            query += *from != ' ';
            from++;
        }
        const int bonus = *query ? 0 : from == end ? 60 : 15;
        if (bonus > best) best = bonus;
        at = end + (*end == ',');
    }
    return best;
}

/* At least 1, also of an empty label. */
static int word_count(const char *text)
{
    int count = 1;
    for (; *text; text++) count += *text == ' ' || *text == ',';
    return count;
}

int wr_search_rank(const WrSearchQuery *query, const char *const field[WR_SEARCH_FIELDS], bool any)
{
    static const int weights[WR_SEARCH_FIELDS] = { 100, 95, 90, 40, 12 };
    int sum = 0, bonus = 0, in_label = 0, missing = 0;
    if (query->count == 0) return 1;
    for (int w = 0; w < query->count; w++) {
        int best = 0;
        for (int f = 0; f < WR_SEARCH_FIELDS; f++) {
            if (!field[f]) continue;
            const int m = match_text(query->words[w], field[f], f <= WR_SEARCH_ALSO);
            if (f <= WR_SEARCH_ENGLISH && m > 60 && best <= m * weights[f]) in_label++;
            if (m * weights[f] > best) best = m * weights[f];
        }
        missing += best == 0;
        sum += best;
    }
    for (int f = 0; f <= WR_SEARCH_ALSO; f++) {
        const int one = field[f] ? phrase_bonus(query->joined, field[f]) : 0;
        if (one > bonus) bonus = one;
    }
    if (bonus < 60 && (missing > 0 && (!any || missing == query->count))) return 0;
    const int words = field[WR_SEARCH_LABEL] ? word_count(field[WR_SEARCH_LABEL]) : 1;
    const int covered = in_label < words ? in_label : words;
    return 1 + sum / query->count + 100 * bonus + 2000 * covered / words;
}
