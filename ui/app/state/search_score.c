#include "ui/app/state/search_score.h"

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
