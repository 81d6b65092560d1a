#!/usr/bin/perl
# The report's pages, of what the lessons' programs have written (see report.mk):
#
#   report.pl FOLDER LESSON... [-- LESSON...]
#
# Writes FOLDER/LESSON.html for each lesson before the --, and of all of them results.csv, curves.csv,
# hard_cases.csv and index.html; a lesson after the -- is passed over if it has not been measured. Numbers come
# from FOLDER/LESSON.csv, -curves.csv and -cases.csv, names from LESSON.list, pictures from FOLDER/LESSON/.
# Whatever is missing ends it with one line.
use strict;
use warnings;
use utf8;
use List::Util qw(min max first uniq any);

my @FIGURES = (    # the standard metrics, in the order of the tables: metric, heading
    ['cost_ratio', 'cost ratio'], ['ns_per_pixel', 'ns/pixel'], ['prepare_ns_per_pixel', 'prepare, ns/pixel'],
    ['rmse', 'rmse'], ['flip', 'flip'], ['psnr_db', 'psnr, dB'], ['max_abs', 'max'],
    ['rmse_gaussian', 'rmse, Gaussian'], ['flip_gaussian', 'flip, Gaussian'],
    ['psnr_db_gaussian', 'psnr, Gaussian'], ['max_abs_gaussian', 'max, Gaussian'],
    ['uv_error_texels_rms', 'uv error rms, texels'], ['uv_error_texels_max', 'uv error max, texels'],
    ['coverage_error_percent', 'coverage error, %']);
my %STANDARD = map { $_->[0] => 1 } @FIGURES, ['truth_rmse'], ['truth_rmse_gaussian'];

# A technique is known by colour and shape, in plots and in text. Okabe and Ito's colours, which colour-blind
# readers tell apart, without their black and yellow, which do not show on every ground. [number, sign] of gnuplot.
my @COLOURS = ('#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9', '#8A7F72');
my @SHAPES = ([7, '●'], [5, '■'], [9, '▲'], [13, '◆'], [11, '▼']);
my ($folder, $css, @plots, %lesson);

sub stop { print STDERR "report.pl: $_[0]\n"; exit 1 }
sub text { my $text = shift; $text =~ s/&/&amp;/g; $text =~ s/</&lt;/g; $text =~ s/"/&quot;/g; return $text }

sub slurp {
    open my $in, '<:encoding(UTF-8)', $_[0] or stop("$_[0]: $!");
    local $/;
    return scalar <$in>;
}

sub spew {
    my ($path, @text) = @_;
    open my $out, '>:encoding(UTF-8)', "$path.partial" or stop("$path: $!");
    (print $out @text) && close $out && rename "$path.partial", $path or stop("$path: $!");
}

# ---- Reading ----

# A table's rows as hashes; its header must be the one expected. A field may stand in double quotes.
sub rows {
    my ($path, $header) = @_;
    my ($first, @lines) = split /\n/, slurp($path);
    stop("$path: its header is not $header") if ($first // '') ne $header;
    my @names = split /,/, $header;
    return map {
        my @fields = map { s/^"(.*)"$/$1/s ? s/""/"/gr : $_ } /\G((?:"(?:[^"]|"")*"|[^,"]*))(?:,|$)/g;
        pop @fields if @fields == @names + 1;    # the empty match at the line's end
        stop("$path: not " . @names . " fields: $_") if @fields != @names;
        my %row;
        @row{@names} = @fields;
        \%row;
    } @lines;
}

my %HEADER = (
    '' => 'lesson,scene,technique,knob,view,metric,value,unit',
    '-curves' => 'lesson,scene,technique,knob,view,curve,x_name,x,y_name,y',
    '-cases' => 'lesson,function,case,float_value,double_value,error,bound,unit,pass');

# Everything about a lesson: its scenes, each with views, variants (a technique with one value of its knob)
# and numbers: value{view}{variant}{metric}.
sub load {
    my $name = shift;
    my $lesson = {name => $name, title => $name, size => [640, 480]};
    my (%scene, $scene, %style);
    for (split /\n/, slurp("$folder/$name.list")) {
        $lesson->{title} = $1 if /^lesson \S+: (.*)/;
        $lesson->{size} = [$1, $2] if /^size (\d+) (\d+)/;
        $scene = $scene{$1} = {name => $1, what => $2, views => [], variants => [], order => [], own => []}
            if /^scene (\S+): (.*)/;
        if (/^  technique (\S+): (.*)/) {
            push @{$scene->{order}}, $1;
            my $count = keys %style;
            my $k = $style{$1} //= $count;    # the same in all scenes
            my ($point, $sign) = @{$SHAPES[$k % @SHAPES]};
            $scene->{technique}{$1} =
                {name => $1, what => $2, colour => $COLOURS[$k % @COLOURS], point => $point, sign => $sign};
        }
        $scene->{technique}{$scene->{order}[-1]}{knob} = $1 if /^    knob (\S+)/;
    }
    for (rows("$folder/$name.csv", $HEADER{''})) {
        my ($scene, $view, $metric) = ($scene{$_->{scene}}, @$_{qw(view metric)});
        $scene or stop("$folder/$name.csv: $name --list knows no scene $_->{scene}");
        push @{$lesson->{scenes}}, $scene unless any { $_ == $scene } @{$lesson->{scenes}};
        my $id = $_->{technique} . ($_->{knob} ne '' ? "-$_->{knob}" : '');
        my $technique = $scene->{technique}{$_->{technique}};
        $technique || $id eq 'truth' or stop("$folder/$name.csv: --list knows no technique $_->{technique}");
        push @{$scene->{variants}}, {id => $id, knob => $_->{knob}, technique => $technique}
            unless $id eq 'truth' || any { $_->{id} eq $id } @{$scene->{variants}};
        my $views = $scene->{$metric eq 'ns_per_pixel' ? 'views' : 'measured'} //= [];
        push @$views, $view unless $view eq '-' || $view eq 'path' || any { $_ eq $view } @$views;
        push @{$scene->{own}}, $metric unless $STANDARD{$metric} || any { $_ eq $metric } @{$scene->{own}};
        $scene->{unit}{$metric} = $_->{unit};
        $_->{value} =~ /^-?[0-9.]+(e[-+]?[0-9]+)?$/ or stop("$folder/$name.csv: $metric of $id is $_->{value}");
        $scene->{value}{$view}{$id}{$metric} = $_->{value};
    }
    $lesson->{scenes} or stop("$folder/$name.csv: no rows");
    for my $scene (@{$lesson->{scenes}}) {    # a missing picture or number is a failure
        my %shown = map { $_ => 1 } @{$scene->{views}};    # extra views are measured, not timed, and not pictured
        $scene->{extra} = [grep { !$shown{$_} } @{$scene->{measured}}];
        for my $view (@{$scene->{views}}) {
            for my $id ('truth', map { $_->{id} } @{$scene->{variants}}) {
                for ($id eq 'truth' ? $id : ($id, "$id-error")) {
                    my $picture = "$folder/" . path($lesson, $scene, $view, $_);
                    -s $picture or stop("$picture: is missing");
                }
                for ($id eq 'truth' ? 'truth_rmse' : qw(rmse flip cost_ratio ns_per_pixel)) {
                    my $value = $scene->{value}{$view}{$id}{$_};
                    defined $value or stop("$folder/$name.csv: no $_ of $scene->{name}, $id, $view");
                }
            }
        }
    }
    -e "$folder/$name$_.csv" and $lesson->{$_} = [rows("$folder/$name$_.csv", $HEADER{$_})] for '-curves', '-cases';
    my @date = localtime((stat "$folder/$name.csv")[9]);
    $lesson->{date} = sprintf '%d-%02d-%02d', $date[5] + 1900, $date[4] + 1, $date[3];
    return $lesson;
}

sub path {
    my ($lesson, $scene, $view, $id) = @_;
    return "$lesson->{name}/$scene->{name}-$view-$id.png";
}

# What an error of a view cannot be told below: three times the truth's own.
sub limit {
    my ($scene, $view, $metric) = @_;
    return $metric =~ /^rmse(.*)/ ? 3 * ($scene->{value}{$view}{truth}{"truth_rmse$1"} // 0) : 0;
}

# ---- Numbers ----

# Three significant digits.
sub digits {
    my $x = shift;
    return '0' if $x == 0;
    my ($mantissa, $exponent) = split /e/, sprintf '%.2e', $x;
    return $mantissa . 'e' . ($exponent + 0) if $exponent < -4 || $exponent > 6;
    return sprintf '%.*f', max(0, 2 - $exponent), "${mantissa}e$exponent";
}

# A number of a metric as text, or as a limit; an empty text where there is none.
sub figure {
    my ($scene, $view, $id, $metric) = @_;
    my $value = $scene->{value}{$view}{$id}{$metric} // return '';
    my $limit = limit($scene, $view, $metric);
    return $value < $limit ? '< ' . digits($limit) : digits($value);
}

# Cells of one column, their decimal points below each other: unseen digits fill what is missing on the right.
sub column {
    my @fraction = map { /(\.\S*)$/ ? length $1 : 0 } @_;
    my $longest = max(0, @fraction);
    return map {
        my $missing = $longest - $fraction[$_];
        my $fill = $missing == 0 ? '' : $fraction[$_] ? '0' x $missing : '.' . '0' x ($missing - 1);
        '<td>' . text($_[$_]) . ($missing ? "<i>$fill</i>" : '') . '</td>';
    } 0 .. $#_;
}

# A table of columns [heading, cells...]; the caption and the first column are HTML.
sub table {
    my ($caption, $first, @columns) = @_;
    my ($corner, @names) = @$first;
    my @cells = map { [column(@$_[1 .. $#$_])] } @columns;
    return '<div class="wide"><table>', $caption ? "<caption>$caption</caption>" : '',
        "<thead><tr><th>$corner</th>", (map { "<th>$_->[0]</th>" } @columns), "</tr></thead>\n<tbody>",
        (map { my $k = $_; "<tr><th>$names[$k]</th>" . join('', map { $_->[$k] } @cells) . "</tr>\n" } 0 .. $#names),
        "</tbody></table></div>\n";
}

sub sign { my $technique = shift; return qq(<b style="color:$technique->{colour}">$technique->{sign}</b>) }

sub label {
    my $variant = shift;
    my $knob = $variant->{knob} ne '' ? " $variant->{knob} <small>$variant->{technique}{knob}</small>" : '';
    return sign($variant->{technique}) . " $variant->{technique}{name}$knob";
}

# ---- Pictures ----

sub image {
    my ($lesson, $source, $alt, $class) = @_;
    return sprintf '<img src="%s" alt="%s" width="%d" height="%d" loading="lazy"%s>', text($source), text($alt),
        @{$lesson->{size}}, $class ? qq( class="$class") : '';
}

# The truth, then each technique's picture beside its heat map; the truth lies hidden on each picture.
sub strip {
    my ($lesson, $scene, $view) = @_;
    my ($truth, @html) = path($lesson, $scene, $view, 'truth');
    for my $variant (@{$scene->{variants}}) {
        my $id = $variant->{id};
        my ($picture, $error) = map { path($lesson, $scene, $view, $_) } $id, "$id-error";
        my %f = map { $_->[0] => text(figure($scene, $view, $id, $_->[0])) } @FIGURES;
        my @errors = ("rmse $f{rmse}", "flip $f{flip}");
        $errors[0] .= ' (limit of the truth)' if $f{rmse} =~ /^&lt;/;
        push @errors, "uv error $f{uv_error_texels_rms} texels" if $f{uv_error_texels_rms} ne '';
        push @html, qq(<figure><div class="pair"><a class="blink" href="$picture">),
            image($lesson, $picture, "$id, $view"), image($lesson, $truth, '', 'truth'),
            qq(</a><a href="$error">), image($lesson, $error, "error of $id, $view"), '</a></div><figcaption>',
            label($variant), '<br>', join(' · ', @errors), "<br>$f{ns_per_pixel} ns/pixel · cost $f{cost_ratio}",
            "</figcaption></figure>\n";
    }
    my $rmse = digits($scene->{value}{$view}{truth}{truth_rmse});
    return qq(<div class="strip"><figure><div class="pair"><a href="$truth">), image($lesson, $truth, "truth, $view"),
        qq(</a><div class="scale"><span>flip 1</span><div></div><span>0</span></div></div><figcaption><b>truth</b><br>),
        "itself uncertain by $rmse (rmse)</figcaption></figure>\n", @html, "</div>\n";
}

# ---- Plots ----

# Marks of a logarithmic axis: the decades of a long one, more of a short one.
sub marks {
    my ($low, $high) = map { log($_) / log 10 } @_;
    my @steps = $high - $low > 2.2 ? (1) : $high - $low > 0.9 ? (1, 2, 5) : (1, 1.5, 2, 3, 5, 7);
    my @decades = map { 10**$_ } int($low) - 1 .. int($high) + 1;
    return join ', ', map { my $decade = $_; map { sprintf '"%1$g" %1$g', $_ * $decade } @steps } @decades;
}

# Adds a plot: lines are {data => [[x, y, label or '']...], style}. Returns its place in the page.
sub plot {
    my ($lesson, $file, $title, $x_axis, $y_axis, $setup, @lines) = @_;
    my $svg = "$lesson->{name}/plot-$file.svg";
    my $script = <<END . $setup;
reset
set output "$folder/$svg"
set tmargin 1.8; set bmargin 3; set rmargin 2
set border 3 lc rgb "#808080"
set tics nomirror scale 0.6
set grid lc rgb "#c0808080" lt 1
unset key
set title "$title" offset 0,-0.6
set xlabel "$x_axis" offset 0,0.4
set ylabel "$y_axis" offset 0.8
END
    my @drawn;
    for my $i (0 .. $#lines) {
        $script .= "\$d$i << END\n" . join('', map { qq($_->[0] $_->[1] "$_->[2]"\n) } @{$lines[$i]{data}}) . "END\n";
        push @drawn, "\$d$i $lines[$i]{style}";
        push @drawn, qq(\$d$i using 1:2:3 with labels left offset 0.6,0.5 font ",11") if any { $_->[2] ne '' } @{$lines[$i]{data}};
    }
    push @plots, {svg => "$folder/$svg", script => $script . 'plot ' . join(', ', @drawn) . "\n"};
    my $alt = text("$title: $y_axis against $x_axis");
    return qq(<a href="$svg"><img src="$svg" alt="$alt" width="400" height="300" loading="lazy"></a>\n);
}

# Where a variant's time goes, C and GL together: what lessons can be compared by, for each holds its cost ratios
# against a first technique of its own.
sub whole_ns {
    my $value = shift;
    return defined $value->{ns_per_pixel} ? $value->{ns_per_pixel} + ($value->{prepare_ns_per_pixel} // 0) : undef;
}

# The cost ratio, and what C prepares in the same measure: a plot without that would call a pre-warp free.
sub whole_ratio {
    my $value = shift;
    return $value->{cost_ratio} unless defined $value->{prepare_ns_per_pixel};
    return $value->{cost_ratio} * (1 + $value->{prepare_ns_per_pixel} / $value->{ns_per_pixel});
}

# Lines of a plot of error against cost: for each technique of a scene [cost, error, label] by its knob's values. An
# error of which only a limit is known stands at the limit.
sub front {
    my ($scene, $view, $metric, $cost) = @_;
    my %lines;
    for my $variant (@{$scene->{variants}}) {
        my $value = $scene->{value}{$view}{$variant->{id}};
        my ($x, $y) = ($cost->($value), $value->{$metric});
        push @{$lines{$variant->{technique}{name}}}, [$x, max($y, limit($scene, $view, $metric)), $variant->{knob}]
            if defined $x && defined $y;
    }
    return map { {technique => $scene->{technique}{$_}, data => $lines{$_}} } grep { $lines{$_} } @{$scene->{order}};
}

# Such a plot. Lines that are dashed come from another lesson.
sub front_plot {
    my ($lesson, $file, $title, $x_axis, $metric, $limit, @lines) = @_;
    my @x = map { $_->[0] } map { @{$_->{data}} } @lines;
    my @y = grep { $_ > 0 } map { $_->[1] } map { @{$_->{data}} } @lines or return;
    my ($x0, $x1, $y0, $y1) = (min(@x) / 1.2, max(@x) * 1.5, min(@y) / 1.7, max(@y) * 1.7);
    my $setup = "set logscale xy\nset xrange [$x0:$x1]\nset yrange [$y0:$y1]\n"
        . 'set xtics (' . marks($x0, $x1) . ")\nset ytics (" . marks($y0, $y1) . ")\n";
    $setup .= qq(set arrow from $x0, $limit to $x1, $limit nohead dt 3 lc rgb "#808080"\n)
        . qq(set label "limit of the truth" at $x1, $limit right offset 0,-0.6 font ",11"\n) if $limit > $y0;
    return plot($lesson, $file, $title, $x_axis, $metric =~ tr/_/ /r, $setup, map {
        my ($t, $dash) = ($_->{technique}, $_->{dashed} ? 'dt 2 ' : '');
        $_->[1] = max($_->[1], $y0 * 1.02) for @{$_->{data}};    # an error of 0 lies on the lower edge
        {data => $_->{data}, style => qq(with linespoints lw 1.6 ${dash}ps 0.9 pt $t->{point} lc rgb "$t->{colour}")}
    } @lines);
}

# Error against cost, a plot for each view.
sub cost_plots {
    my ($lesson, $scene, $metric) = @_;
    return map {
        front_plot($lesson, "$scene->{name}-$_-$metric", $_, 'cost ratio', $metric, limit($scene, $_, $metric),
            front($scene, $_, $metric, \&whole_ratio));
    } @{$scene->{views}};
}

# The same with the lines of each earlier lesson that measured this of a scene and view of the same names.
sub compared_plots {
    my ($lesson, $scene, $metric) = @_;
    my @html;
    for my $view (@{$scene->{views}}) {
        my @others;
        for my $other (map { $lesson{$_} } grep { $_ lt $lesson->{name} } sort keys %lesson) {
            my ($same) = grep { $_->{name} eq $scene->{name} } @{$other->{scenes}};
            my ($number) = $other->{name} =~ /^(\d+)/;
            push @others, map {
                $_->{data}[-1][2] = "$number $_->{technique}{name} $_->{data}[-1][2]";
                +{%$_, dashed => 1}
            } front($same, $view, $metric, \&whole_ns) if $same;
        }
        push @html, front_plot($lesson, "$scene->{name}-$view-$metric-compared", $view, 'ns per pixel', $metric, 0,
            @others, front($scene, $view, $metric, \&whole_ns)) if @others;
    }
    return @html;
}

# The lesson's own curves, a line for each technique, knob and view: a plot for each curve, or for each of its
# views where the lines are many or long. Bounds are dashed, in every plot that has their axes.
sub curve_plots {
    my ($lesson, $scene) = @_;
    my @points = grep { $_->{scene} eq $scene->{name} } @{$lesson->{'-curves'} // []};
    my @html;
    for my $curve (uniq map { $_->{curve} } grep { $_->{curve} !~ /(^|-)bound$/ } @points) {
        my @mine = grep { $_->{curve} eq $curve } @points;
        my ($x_name, $y_name) = @{$mine[0]}{'x_name', 'y_name'};
        push @mine, grep {
            $_->{curve} =~ /^(\Q$curve\E-)?bound$/ && $_->{x_name} eq $x_name && $_->{y_name} eq $y_name
        } @points;
        my @views = uniq map { $_->{view} } grep { $_->{curve} eq $curve } @mine;
        my $lines = uniq map { join ',', @$_{qw(curve technique knob view)} } @mine;
        my @panels = $lines > 16 || @mine > 40 * $lines ? map { [$_] } @views : [@views];
        for my $panel (@panels) {
            my %in = map { $_ => 1 } @$panel, '-';
            push @html, curve_plot($lesson, $scene, $curve, @$panel == 1 ? $panel->[0] : '-', grep { $in{$_->{view}} } @mine);
        }
    }
    return @html;
}

sub curve_plot {
    my ($lesson, $scene, $curve, $view, @points) = @_;
    my (@order, %line, %range, %log, @labels);
    for (@points) {
        my $id = join ',', @$_{qw(technique knob view curve)};
        push @order, $id unless $line{$id};
        push @{$line{$id}}, [$_->{x}, $_->{y}, ''];
    }
    my $setup = '';
    for my $axis (qw(x y)) {    # logarithmic where that shows more
        my ($low, $high) = (min(map { $_->{$axis} } @points), max(map { $_->{$axis} } @points));
        $log{$axis} = $low > 0 && $high / $low > 50;
        $setup .= "set logscale $axis\nset format $axis '%g'\n" if $log{$axis};
        my $room = $axis eq 'x' ? 0 : ($high - $low) * 0.05 || abs $high || 1;
        $range{$axis} = $log{$axis} ? [$low / 1.2, $high * 1.2] : [$low - $room, $high + $room];
        $setup .= "set ${axis}range [$range{$axis}[0]:$range{$axis}[1]]\n" if $range{$axis}[0] < $range{$axis}[1];
    }
    my @lines = map {
        my ($name, $knob, $line_view, $line_curve) = split /,/;
        my $t = $scene->{technique}{$name} // stop("$folder/$lesson->{name}-curves.csv: --list knows no technique $name");
        my @data = @{$line{$_}};
        my $every = int(@data / 8) + 1;
        my $dashed = $line_curve =~ /(^|-)bound$/;
        my ($end, $low, $high) = map { $log{y} ? log : $_ } $data[-1][1], @{$range{y}};
        my $label = join ', ', grep { $_ ne '' } $knob, $view eq '-' && $line_view ne '-' ? $line_view : '';
        push @labels, [($end - $low) / ($high - $low), $label, $t->{colour}] if $label ne '' && !$dashed;
        {data => \@data, style => $dashed ? qq(with lines lw 1.4 dt 2 lc rgb "$t->{colour}")
            : qq(with linespoints lw 1.4 ps 0.7 pi $every pt $t->{point} lc rgb "$t->{colour}")}
    } @order;
    my ($below, $above) = (-1, 1.05);    # labels stand right of their lines' ends, one above the other
    @labels = sort { $a->[0] <=> $b->[0] } @labels;
    $below = $_->[0] = max($_->[0], $below + 0.065) for @labels;
    $above = $_->[0] = min($_->[0], $above - 0.065) for reverse @labels;
    $setup .= qq(set label "$_->[1]" at graph 1.02, graph $_->[0] tc rgb "$_->[2]" font ",11"\n) for @labels;
    $setup .= 'set rmargin ' . (2 + max(map { length $_->[1] } @labels)) . "\n" if @labels;
    my ($x_name, $y_name) = map { tr/_/ /r } @{$points[0]}{'x_name', 'y_name'};
    my $title = $view eq '-' ? $curve : "$curve, $view";
    return plot($lesson, "$scene->{name}-$view-curve-$curve", $title, $x_name, $y_name, $setup, @lines);
}

sub draw_plots {
    return unless @plots;
    open my $gnuplot, '|-', 'gnuplot' or stop("gnuplot: $!");
    binmode $gnuplot, ':encoding(UTF-8)';
    print $gnuplot qq(set terminal svg size 400,300 font "sans-serif,13" noenhanced\n), map { $_->{script} } @plots;
    close $gnuplot or stop('gnuplot: failed; its message is above');
    for (@plots) {    # letters and black lines take the reader's colour, light or dark
        my $svg = slurp($_->{svg});
        $svg =~ s/(fill|stroke)=(["'])black\2/$1="currentColor"/g;
        $svg =~ s/color="black"//g;
        $svg =~ s/<defs>/<style>svg{color:#222}\@media(prefers-color-scheme:dark){svg{color:#ddd}}<\/style>\n<defs>/;
        spew($_->{svg}, $svg);
    }
    @plots = ();
}

# ---- A lesson's page ----

sub page {
    my ($title, @body) = @_;
    return qq(<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n),
        qq(<meta name="viewport" content="width=device-width, initial-scale=1">\n<title>), text($title),
        "</title>\n<style>\n$css</style>\n</head>\n<body>\n", @body, "</body>\n</html>\n";
}

# The README's title, and the rest as HTML, whose links lead from the report to the lesson's folder.
sub readme {
    my $lesson = shift;
    my $file = "lessons/$lesson->{name}/README.md";
    -e $file or return (text("$lesson->{name}: $lesson->{title}"), "<p>This lesson has no README.md yet.</p>\n");
    my @command = (qw(pandoc -f gfm+tex_math_dollars -t html --mathml --wrap=preserve), $file);
    open my $pandoc, '-|:encoding(UTF-8)', @command or stop("pandoc: $!");
    my $html = do { local $/; <$pandoc> };
    close $pandoc or stop("pandoc: cannot render $file");
    $html =~ s{\b(src|href)="(?![a-z]+:|/|#)}{$1="../../lessons/$lesson->{name}/}g;
    my $title = $html =~ s{<h1[^>]*>(.*?)</h1>\n?}{}s ? $1 : text("$lesson->{name}: $lesson->{title}");
    return ($title, $html);
}

sub view_table {
    my ($scene, $view) = @_;
    my @variants = @{$scene->{variants}};
    my $value = $scene->{value}{$view};
    my @columns;
    for my $figure (@FIGURES) {
        my ($metric, $heading) = @$figure;
        next unless any { defined $value->{$_->{id}}{$metric} } @variants;
        push @columns, [$heading, map { figure($scene, $view, $_->{id}, $metric) } @variants];
    }
    my $limited = any { /^</ } map { @$_ } @columns;
    return table($limited ? '&lt;: below three times the error of the truth itself, so no more can be said' : '',
        ['technique', map { label($_) } @variants], @columns);
}

# A metric of the lesson's own: techniques down, views across; where views are many, the other way round.
sub own_table {
    my ($scene, $metric, @views) = @_;
    my $value = $scene->{value};
    my @variants = grep {
        my $id = $_->{id};
        any { defined $value->{$_}{$id}{$metric} } keys %$value;
    } @{$scene->{variants}};
    @views = grep {
        my $view = $_;
        any { defined $value->{$view}{$_->{id}}{$metric} } @variants;
    } @views or return;
    my $unit = $scene->{unit}{$metric};
    my $caption = "<b>$metric</b>" . ($unit eq '1' ? '' : ', ' . text($unit));
    my @names = map { $_ eq '-' ? 'all' : $_ } @views;
    my $cell = sub { my ($view, $variant) = @_; figure($scene, $view, $variant->{id}, $metric) };
    if (@views > 12) {
        return table($caption, ['view', @names],
            map { my $variant = $_; [label($variant), map { $cell->($_, $variant) } @views] } @variants);
    }
    return table($caption, ['technique', map { label($_) } @variants],
        map { my $k = $_; [$names[$k], map { $cell->($views[$k], $_) } @variants] } 0 .. $#views);
}

sub scene_html {
    my ($lesson, $scene) = @_;
    my $name = $scene->{name};
    my @techniques = uniq map { $_->{technique} } @{$scene->{variants}};
    my $key = join ' ', map { '<span>' . sign($_) . " $_->{name}</span>" } @techniques;
    my @legend = map { '<li>' . sign($_) . " <b>$_->{name}</b> " . text($_->{what}) . "</li>\n" } @techniques;
    my @html = (qq(<section>\n<h2 id="$name">Scene <code>$name</code></h2>\n<p>), text($scene->{what}), ".</p>\n",
        qq(<ul class="legend">\n), @legend, "</ul>\n");
    push @html, qq(<h3 id="$name-$_">View <code>$_</code></h3>\n), strip($lesson, $scene, $_), view_table($scene, $_)
        for @{$scene->{views}};
    for (['Error against cost', cost_plots($lesson, $scene, 'rmse')],
        ['Error against cost, for the Gaussian pixel', cost_plots($lesson, $scene, 'rmse_gaussian')],
        ['Error of the lookup against cost', cost_plots($lesson, $scene, 'uv_error_texels_rms')],
        (map { ["<code>$_</code> against cost", cost_plots($lesson, $scene, $_)],
               ["<code>$_</code> against time, beside earlier lessons (dashed)", compared_plots($lesson, $scene, $_)] }
            grep { /^wrong_|error/ } @{$scene->{own}}),
        ['Curves', curve_plots($lesson, $scene)]) {
        my ($heading, @made) = @$_;
        push @html, qq(<h3>$heading</h3>\n<p class="key">$key</p>\n<div class="plots">\n), @made, "</div>\n" if @made;
    }
    my @own = map { own_table($scene, $_, @{$scene->{views}}, @{$scene->{extra}}, 'path', '-') } @{$scene->{own}};
    my @extra = map { own_table($scene, $_->[0], @{$scene->{extra}}) } @FIGURES;
    push @html, qq(<h3>Views that are not pictured</h3>\n<div class="tables">\n), @extra, "</div>\n" if @extra;
    push @html, qq(<h3>This lesson's own measures</h3>\n<div class="tables">\n), @own, "</div>\n" if @own;
    return @html, "</section>\n";
}

# Failures first, then flips: where a comparison in float went the other way than in double.
sub cases_html {
    my $lesson = shift;
    my %rank = (no => 0, flip => 1, yes => 2);
    my @rows = sort { ($rank{$a->{pass}} // 0) <=> ($rank{$b->{pass}} // 0) } @{$lesson->{'-cases'} // []};
    @rows or return '';
    my $flips = grep { $_->{pass} eq 'flip' } @rows;
    my $bad = grep { !$rank{$_->{pass}} } @rows;
    my $format = qq(<tr class="%s"><th>%s</th><th>%s</th><td>%.9g</td><td>%.9g</td><td>%.3g</td><td>%.3g</td>)
        . "<th>%s</th><th>%s</th></tr>\n";
    my @fields = qw(function case float_value double_value error bound unit pass);
    my $count = @rows;
    my $open = $bad ? ' open' : '';
    return <<END, (map { '<th>' . s/_value//r . '</th>' } @fields), "</tr></thead>\n<tbody>", (map {
<section>
<h2 id="cases">Hard cases</h2>
<p>Each function of the shaders, in GLSL and, by GLM, in C++, both in float, held against the same lines in double: $count values,
<b>$bad failed</b>, $flips flipped (rounding turned a comparison).</p>
<details$open><summary>All values</summary><div class="wide"><table class="cases"><thead><tr>
END
        my $row = $_;
        sprintf $format, $rank{$_->{pass}} ? $_->{pass} : 'no', map { text($row->{$_}) } @fields;
    } @rows), "</tbody></table></div></details>\n</section>\n";
}

sub lesson_page {
    my $lesson = shift;
    my ($title, $readme) = readme($lesson);
    my @links = '<a href="index.html">Texel by Texel</a>';
    for my $scene (@{$lesson->{scenes}}) {
        push @links, qq(<a href="#$scene->{name}">$scene->{name}</a>);
        push @links, map { qq(<a class="view" href="#$scene->{name}-$_">$_</a>) } @{$scene->{views}};
    }
    push @links, '<a href="#cases">hard cases</a>' if $lesson->{'-cases'};
    my $size = join ' x ', @{$lesson->{size}};
    my @scenes = map { scene_html($lesson, $_) } @{$lesson->{scenes}};
    draw_plots();
    my @page = page("$lesson->{name}: $lesson->{title}", <<END, @scenes, cases_html($lesson), "</main>\n");
<nav>@links</nav>
<main>
<h1>$title</h1>
<article>
$readme</article>
<p class="note">Left a picture, right its error (flip; black is none). <b>Rest the pointer on a picture, and the truth takes its
place.</b> Each opens at its full size, $size. In the plots of cost, lower and further left is better, and a line joins the values
of a knob.</p>
END
    spew("$folder/$lesson->{name}.html", @page);
}

# ---- The index ----

sub range {
    my ($low, $high) = map { digits($_) } min(@_), max(@_);
    return $low eq $high ? $low : "$low to $high";
}

# A row for each technique of a lesson, over its scenes, views and knobs.
sub summary {
    my $lesson = shift;
    my (@order, %values);
    for my $scene (@{$lesson->{scenes}}) {
        for my $variant (@{$scene->{variants}}) {
            my $name = $variant->{technique}{name};
            push @order, $name unless $values{$name};
            for my $view (@{$scene->{views}}) {
                my $value = $scene->{value}{$view}{$variant->{id}};
                push @{$values{$name}{$_}}, max($value->{$_}, limit($scene, $view, $_)) for qw(cost_ratio rmse flip);
            }
        }
    }
    return table(qq(<a href="$lesson->{name}.html"><b>$lesson->{name}</b></a>), ['technique', @order], map {
        my $metric = $_;
        [$metric =~ tr/_/ /r, map { range(@{$values{$_}{$metric}}) } @order];
    } qw(cost_ratio rmse flip));
}

# The view in which the lesson's first technique errs most: half of it beside half of the truth.
sub card {
    my $lesson = shift;
    my $scene = $lesson->{scenes}[0];
    my $id = $scene->{variants}[0]{id};
    my ($view) = sort { $scene->{value}{$b}{$id}{flip} <=> $scene->{value}{$a}{$id}{flip} } @{$scene->{views}};
    return qq(<figure><a class="halves" href="$lesson->{name}.html">),
        image($lesson, path($lesson, $scene, $view, $id), "$lesson->{name}: $id"),
        image($lesson, path($lesson, $scene, $view, 'truth'), '', 'truth'),
        qq(</a><figcaption><a href="$lesson->{name}.html"><b>$lesson->{name}</b></a><br>), text($lesson->{title}),
        "<br><small>left $id, right the truth</small></figcaption></figure>\n";
}

sub index_page {
    my @lessons = @_;
    my $cpuinfo = -r '/proc/cpuinfo' ? slurp('/proc/cpuinfo') : '';
    my $cpu = text($cpuinfo =~ /^model name\s*:\s*(.*)/m ? $1 : 'an unknown processor');
    my $cores = () = $cpuinfo =~ /^processor\s*:/mg;
    my $sizes = join ', ', uniq map { join ' x ', @{$_->{size}} } @lessons;
    my @dates = uniq sort map { $_->{date} } @lessons;
    my $dates = join ' to ', @dates > 1 ? @dates[0, -1] : @dates;
    return page('Texel by Texel', <<END, (map { card($_) } @lessons), <<END, (map { summary($_) } @lessons), <<END);
<main>
<h1>Texel by Texel</h1>
<p>What each technique of texture mapping costs, and how far its picture is from the exact one.</p>
<div class="cards">
END
</div>
<h2>Cost and error</h2>
<div class="tables">
END
</div>
<p class="note">Least to most over a lesson's scenes, views and knobs. Cost ratio: the time of a finished frame to that of the
scene's first technique; all take turns for some rounds, and the median counts. Rmse: of linear RGB over the whole picture, before
it is quantised, held against an exact ray caster in doubles; none is given below three times the error of that truth. Flip: the
mean of LDR-FLIP (Andersson et al. 2020), 0 to 1.</p>
<p class="note">Measured $dates at $sizes pixels on $cpu, cores: $cores. Every number: <a href="results.csv">results.csv</a>,
<a href="curves.csv">curves.csv</a>, <a href="hard_cases.csv">hard_cases.csv</a>.</p>
</main>
END
}

# One table of all lessons, under one header.
sub join_tables {
    my ($ending, $to, @names) = @_;
    my @all;
    for my $path (grep { -e } map { "$folder/$_$ending.csv" } @names) {
        my ($header, @lines) = split /\n/, slurp($path);
        stop("$path: its header is not $HEADER{$ending}") if $header ne $HEADER{$ending};
        push @all, @lines;
    }
    spew("$folder/$to.csv", map { "$_\n" } $HEADER{$ending}, @all);
}

($folder, my @names) = @ARGV;
my $split = first { $names[$_] eq '--' } 0 .. $#names;
my @pages = defined $split ? @names[0 .. $split - 1] : @names;
my @others = defined $split ? grep { -e "$folder/$_.csv" } @names[$split + 1 .. $#names] : ();
@pages or stop('usage: report.pl FOLDER LESSON... [-- LESSON...]');
system("command -v $_ >/dev/null 2>&1") == 0 or stop("$_: not found; make install brings it") for qw(gnuplot pandoc);
$css = slurp('common/report.css');
%lesson = map { $_ => load($_) } uniq @pages, @others;
lesson_page($lesson{$_}) for @pages;
my @all = sort keys %lesson;
join_tables('', 'results', @all);
join_tables('-curves', 'curves', @all);
join_tables('-cases', 'hard_cases', @all);
spew("$folder/index.html", index_page(map { $lesson{$_} } @all));
print "$folder/", @pages == 1 && defined $split ? "$pages[0].html" : 'index.html', "\n";
