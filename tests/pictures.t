#!/usr/bin/perl
# Pictures as tests: each lesson is measured at 320x240 and held against the bounds in its expect.csv; and its
# reviewed pictures in tests/golden/ are drawn again. What measures time must run last and alone.
#
#   tests/pictures.t [--errors | --costs] [NN-name...]     all rows of all lessons, or those
#
# A bound is empty, a number, or [FACTOR*]TECHNIQUE[:KNOB]: that row's value of the same metric, scene and view.
use strict;
use warnings;
use Test::More;
use File::Path qw(make_path);

my $size   = '320x240';
my $folder = 'build/tests/pictures';
my $golden = 'tests/golden'; # LESSON.SCENE.VIEW.TECHNIQUE[.KNOB].png; the technique may be truth
my %golden_limit = (max => 4, mean => 0.1); # of 255, OSMesa against OSMesa

sub rows { # of a CSV file with a header, as hashes; its fields hold no commas
    my ($path) = @_;
    open my $file, '<', $path or return;
    chomp(my @lines = grep { /\S/ && !/^#/ } <$file>);
    my @names = split /,/, shift @lines;
    return map { my %row; @row{@names} = split /,/, $_, -1; \%row } @lines;
}

sub key { join '/', @_ }

sub bound { # its number, or undef and why there is none
    my ($text, $row, $values) = @_;
    return $text if $text =~ /^[-+]?[0-9.]+(e[-+]?\d+)?$/i;
    $text =~ /^(?:([0-9.]+)\*)?([a-z][a-z0-9-]*)(?::([0-9.]+))?$/ or return (undef, "'$text' is no bound");
    my ($factor, $technique, $knob) = ($1 // 1, $2, $3 // '');
    my $other = $values->{key($row->{scene}, $technique, $knob, $row->{view}, $row->{metric})};
    return defined $other ? $factor * $other : (undef, "there is no row of $text");
}

sub write_only { # the rows that the bounds are about, and those they refer to: nothing else need be measured
    my ($path, @expected) = @_;
    open my $out, '>', $path or die "$path: $!";
    print $out "scene,technique,knob,view,metric\n";
    for my $row (@expected) {
        my @others = map { m/^(?:[0-9.]+\*)?([a-z][a-z0-9-]*)(?::([0-9.]+))?$/ ? [$1, $2 // ''] : () }
            @{$row}{qw(at_least at_most)};
        print $out join(',', $row->{scene}, @$_, @{$row}{qw(view metric)}), "\n"
            for [@{$row}{qw(technique knob)}], @others;
    }
    close $out;
}

sub row_name { key(@{$_[0]}{qw(scene technique knob view metric)}) }

sub problem { # why a row does not keep its bounds, or undef
    my ($row, $values) = @_;
    my $name  = row_name($row);
    my $value = $values->{$name};
    return "$name: the row is missing" unless defined $value;
    return "$name: expect.csv bounds it on no side" unless "$row->{at_least}$row->{at_most}" =~ /\S/;
    for my $side (['at_least', 1], ['at_most', -1]) {
        my ($column, $sign) = @$side;
        next if $row->{$column} eq '';
        my ($bound, $why) = bound($row->{$column}, $row, $values);
        return "$name: $why" unless defined $bound;
        return "$name: $value, expected $column $row->{$column} = $bound"
            if $sign * ($value - $bound) < 0;
    }
    return undef;
}

sub measure { # the values of the rows that are expected, by name; undef if the program fails
    my ($lesson, $stem, @rows) = @_;
    unlink "$stem.csv";
    write_only("$stem-only.csv", @rows);
    my $said = `build/$lesson --measure $stem.csv --only $stem-only.csv --size $size 2>&1`;
    is($?, 0, "$lesson is measured") or diag $said;
    return map { (row_name($_) => $_->{value}) } rows("$stem.csv");
}

sub check_golden { # all of a lesson's, drawn into a folder of its own, for lessons are checked side by side
    my ($lesson, @paths) = @_;
    my ($into, @pairs) = "$folder/$lesson";
    make_path($into);
    for my $path (@paths) {
        my ($scene, $view, $technique, $knob) = $path =~ m{/[^./]+\.([^.]+)\.([^.]+)\.([^.]+?)(?:\.([0-9.]+))?\.png$}
            or return fail("$path: a golden picture is LESSON.SCENE.VIEW.TECHNIQUE[.KNOB].png");
        my $drawn = $technique eq 'truth' ? "--truth $into" : "--render $into --technique $technique";
        $drawn .= " --knob $knob" if defined $knob;
        system("build/$lesson --size $size --scene $scene --view $view $drawn 2>/dev/null") == 0
            or return fail("$path: cannot be drawn");
        push @pairs, "$into/" . join('-', $scene, $view, $technique, $knob // ()) . ".png $path";
    }
    my @differences = `build/tests/png_difference @pairs`;
    is(@differences, @paths, "$lesson: all golden pictures can be compared");
    for my $i (0 .. $#differences) {
        my ($max, $mean) = split ' ', $differences[$i];
        ok($max <= $golden_limit{max} && $mean <= $golden_limit{mean},
            "$paths[$i]: at most $max/255 off, $mean/255 in the mean");
    }
}

my $phase   = @ARGV && $ARGV[0] =~ /^--(errors|costs)$/ ? shift(@ARGV) : '';
my @lessons = @ARGV ? @ARGV : map { m{^lessons/(.*)} } glob('lessons/[0-9][0-9]-*');
make_path($folder);
for my $lesson (@lessons) {
    my $stem     = "$folder/$lesson$phase";
    my @expected = rows("lessons/$lesson/expect.csv");
    ok(@expected > 0, "$lesson/expect.csv expects something");
    @expected = grep { ($phase eq '--costs') == ($_->{metric} =~ /^(ns_per_pixel|cost_ratio|scatter_ratio|brute_ratio|embree_ratio)/) } @expected if $phase;
    if (@expected) {
        my %values = measure($lesson, $stem, @expected);
        # What else the machine does may be in a time, now and then; what is in it five times is the program's.
        my @left = grep { defined problem($_, \%values) } @expected;
        for (2 .. ($phase eq '--costs' ? 5 : 1)) {
            last unless @left;
            diag problem($_, \%values), ' (measured again)' for @left;
            %values = (%values, measure($lesson, $stem, @left));
            @left = grep { defined problem($_, \%values) } @left;
        }
        my %failed = map { (row_name($_) => 1) } @left;
        for my $row (@expected) {
            my $name = row_name($row);
            ok(!$failed{$name}, "$name = " . ($values{$name} // 'missing')) or diag problem($row, \%values);
        }
    }
    next if $phase eq '--costs';
    my @golden = glob("$golden/$lesson.*.png");
    ok(@golden > 0, "$lesson has a golden picture") && check_golden($lesson, @golden);
}
done_testing();
