/* The time since some moment that does not change, in seconds: what durations are measured by. */
#ifndef TEXEL_CLOCK_H
#define TEXEL_CLOCK_H

double clock_seconds(void);

#endif
