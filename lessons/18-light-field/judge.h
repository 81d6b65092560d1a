/* The lesson's own metrics: README.md says what they mean. */
#ifndef LESSON_JUDGE_H
#define LESSON_JUDGE_H

#include "fields.h"

void judge_field(const Shots *shots, Table *table, const Made *made);

/* The light of the sixteen taps in doubles (Eq. 3 to 5): at the point of the model, toward the eye. The
 * texels must have been kept. */
Vec3 judge_taps(const Made *made, Vec3 at, Vec3 toward);

#endif
