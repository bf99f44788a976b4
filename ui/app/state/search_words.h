/* search_words.h - synonyms of the search: words of other programs for actions, rows, generators and so on. */
#pragma once

typedef struct WrSearchWords {
    const char *label; /* English label of the entry, without dots at its end */
    const char *words; /* comma-separated; translated as a whole */
} WrSearchWords;

extern const WrSearchWords wr_search_words[]; /* ends with label NULL */
