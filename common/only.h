/* Which rows of the tidy table are wanted: a list from a file, so that a test measures what it checks and no
 * more. */
#ifndef TEXEL_ONLY_H
#define TEXEL_ONLY_H

#include <stdbool.h>

typedef struct Only Only;

/* Reads a CSV whose header begins scene,technique,knob,view,metric (an expect.csv, or such columns of a
 * results.csv). Ends the program with a line that names the file if it cannot. only_destroy frees it. */
Only *only_load(const char *path);
void only_destroy(Only *only);

enum { ONLY_ANY_KNOB = -1 };

/* Whether a row is wanted that has this scene, technique, knob, view and metric. NULL, or ONLY_ANY_KNOB: any.
 * A
 * listed view "-" stands for all. With only NULL everything is wanted.
 */
bool only_wants(const Only *only, const char *scene, const char *technique, double knob, const char *view,
                const char *metric);

/* Whether any row is about this view of the scene by its name, a "-" not counting. With only NULL all are. */
bool only_names_view(const Only *only, const char *scene, const char *view);

#endif
