#!/usr/bin/perl
# The window, on a display in memory: its picture against the off-screen one, its keys by the names of what P
# saves, and a shader that is broken and mended while it runs. All of it on a copy of lesson 14; and on one of
# lesson 15, whose light moves by itself.
use strict;
use warnings;
use Test::More;
use File::Temp qw(tempdir);
use IO::Select;
use Time::HiRes qw(sleep time);

my $root   = tempdir(CLEANUP => 1);
my $lesson = "$root/build/14-parallax";
my $saved  = "$root/build/pictures";
my ($display, $window);
delete @ENV{qw(DISPLAY WAYLAND_DISPLAY)};

END {
    my $status = $?;
    foreach my $process (grep { defined } $window, $display) { kill 'TERM', $process; waitpid $process, 0; }
    $? = $status;
}

# ---- A copy of what the lesson needs, so that the tree's own files stay as they are ----
mkdir "$root/$_" or die "$root/$_: $!" foreach qw(build lessons);
my @copied = ([qw(build/14-parallax build/15-relief build/libtexel.so build/libtexel-files.so)], "$root/build", ['common'], $root,
    [qw(lessons/14-parallax lessons/15-relief)], "$root/lessons");
while (my ($from, $to) = splice @copied, 0, 2) { system('cp', '-R', @$from, $to) == 0 or die; }
chomp(my $here = `pwd`);
symlink "$here/build/assets", "$root/build/assets" or die;

# ---- Tools ----
sub wait_for { # up to fifteen seconds for what the function says
    my ($function) = @_;
    for (my $end = time + 15; time < $end; sleep 0.02) {
        my $result = $function->();
        return $result if $result;
    }
    return;
}

sub content {
    open my $in, '<', $_[0] or return '';
    local $/;
    return <$in> // '';
}

sub press { system('xdotool', 'key', '--delay', '0', @_) == 0 or die "xdotool: $?"; }

sub save { # presses the keys and P, and waits for the picture of that name
    my ($name, @keys) = @_;
    unlink "$saved/$name.png";
    press(@keys, 'p');
    return wait_for(sub { -e "$saved/$name.png" });
}

sub saves {
    my ($name, @keys) = @_;
    ok(save($name, @keys), "@keys p: $name.png") or diag 'instead: ' . join ' ', map { s/.*\///r } glob "$saved/*";
}

sub difference { my ($largest) = split ' ', `build/tests/png_difference $_[0] $_[1] 2>&1`; return $largest; }

sub same { # to 4 in 255
    my ($a, $b, $what) = @_;
    my $difference = difference($a, $b);
    ok($difference =~ /^\d+$/ && $difference <= 4, "$what: at most 4/255 apart ($difference)");
}

sub background { # a command that goes on beside this one
    my ($out, $error, @command) = @_;
    my $child = fork // die "fork: $!";
    return $child if $child;
    open STDOUT, '>', $out   or die;
    open STDERR, '>', $error or die;
    exec @command or die "$command[0]: $!";
}

# ---- No display ----
my $refused = `$lesson 2>&1`;
ok($? >> 8 == 1 && $refused =~ /^[^\n]*--render[^\n]*\n\z/, 'no display: status 1, one line that names --render')
    or diag $refused;

# ---- What there is, in the lesson's own order ----
my (@scenes, %techniques, %views, %knobs);
foreach (`$lesson --list`) {
    push @scenes, $1 if /^scene (\S+):/;
    push @{ $techniques{ $scenes[-1] } }, $1 if /^  technique (\S+):/;
    push @{ $views{ $scenes[-1] } },      $1 if /^  view (\S+)/;
    $knobs{"$scenes[-1] $techniques{$scenes[-1]}[-1]"} = [split ' ', $1] if /^    knob \S+ (.*)/;
}

# ---- A display, and the window on it ----
$^F = 20; # the display's number comes through a pipe that Xvfb inherits
pipe my $number, my $number_in or die "pipe: $!";
my $pipe = fileno $number_in;
$display = background('/dev/null', "$root/xvfb", 'Xvfb', '-displayfd', $pipe, '-screen', 0, '1024x768x24',
    '-nolisten', 'tcp');
close $number_in;
my $said = IO::Select->new($number)->can_read(15) ? <$number> : undef;
BAIL_OUT('no display: ' . content("$root/xvfb")) if !$said;
chomp $said;
$ENV{DISPLAY} = ":$said";

my @choice = qw(--scene brick --view 60 --technique per-pixel --size 200x150);
$window = background("$root/out", "$root/error", $lesson, @choice);
system("$lesson @choice --render $root/offscreen 2>>$root/progress") == 0 or die;
system(qw(timeout 15 xdotool search --sync --onlyvisible --name 14-parallax mousemove 100 75)) == 0 or die;

my $first = 'brick-60-per-pixel';
saves($first);
same("$saved/$first.png", "$root/offscreen/$first.png", 'in the window and off-screen');

# ---- Keys ----
my @brick = @{ $techniques{brick} };
sub name { # of the picture of a technique, with its knob's i-th value
    my ($scene, $view, $technique, $i) = @_;
    my $knob = $knobs{"$scene $technique"};
    return "$scene-$view-$technique" . ($knob ? "-$knob->[$i]" : '');
}
saves(name('brick', 60, $brick[1], 0), '2');
saves(name('brick', 60, $brick[2], 0), 'Tab');
my ($knobbed) = grep { $knobs{"brick $brick[$_]"} } 0 .. $#brick;
saves(name('brick', 60, $brick[$knobbed], 0), $knobbed + 1);
saves(name('brick', 60, $brick[$knobbed], 1), 'bracketright');
saves(name('brick', 60, $brick[$knobbed], 0), 'bracketleft', 'bracketleft');
my ($at)  = grep { $views{brick}[$_] eq '60' } 0 .. $#{ $views{brick} };
my $view = $views{brick}[($at + 1) % @{ $views{brick} }];
saves(name('brick', $view, 'plain', 0), '1', 'v');
my ($scene)      = map { $scenes[($_ + 1) % @scenes] } grep { $scenes[$_] eq 'brick' } 0 .. $#scenes;
my ($next_view)  = grep { $_ eq $view } @{ $views{$scene} };
my ($next_plain) = grep { $_ eq 'plain' } @{ $techniques{$scene} };
saves(name($scene, $next_view // $views{$scene}[0], $next_plain // $techniques{$scene}[0], 0), 'n');

# ---- A moved camera, made again off-screen from the command that C prints ----
for (my $i = 1; $i < @scenes; $i++) { press('n'); }
my ($per_pixel) = grep { $brick[$_] eq 'per-pixel' } 0 .. $#brick;
press($per_pixel + 1);
system(qw(xdotool mousemove 100 75 mousedown 1 mousemove 80 90 mousemove 60 95 mouseup 1 click 4)) == 0 or die;
system(qw(xdotool mousedown 3 mousemove 55 99 mouseup 3)) == 0 or die;
my $moved = 'brick-camera-per-pixel';
saves($moved, 'c');
rename "$saved/$moved.png", "$root/moved.png" or die;
my ($command) = content("$root/out") =~ /^(\S*14-parallax .* --view \S+,\S+ .*)$/m;
ok($command && system("cd $root && $command 2>>progress") == 0, 'C prints a command line that runs') or diag content("$root/out");
same("$root/moved.png", "$saved/$moved.png", 'a camera moved by hand and that command');

# ---- A shader, broken and mended ----
my $shader = "$root/lessons/14-parallax/per-pixel.frag";
my $source = content($shader);

sub edit { # as editors do: a new file takes the old one's name
    my ($text) = @_;
    open my $out, '>', "$shader.new" or die;
    print $out $text;
    close $out;
    rename "$shader.new", $shader or die;
}

edit("$source\n\nnonsense;\n");
my $line = () = $source =~ /\n/g;
$line += 3;
ok(wait_for(sub { content("$root/error") =~ /\/per-pixel\.frag:$line: / }), "a broken shader: its file and line $line")
    or diag content("$root/error");
saves($moved);
ok(content("$saved/$moved.png") eq content("$root/moved.png"), 'the last good picture stays');
edit($source =~ s/\}\s*\z/ colour.g = 1.0 - colour.g; }\n/r);
ok(wait_for(sub { save($moved) && content("$saved/$moved.png") ne content("$root/moved.png") }),
    'mended, with another colour: another picture');

# ---- Where saving fails, the window goes on ----
system('rm', '-r', $saved) == 0 or die;
edit($source);
open my $blocked, '>', $saved or die;
press('p');
ok(wait_for(sub { content("$root/error") =~ /\Q$saved\E\/\S+\.png: / }), 'a picture that cannot be saved: the reason');
press('Escape');
my $ended = wait_for(sub { waitpid($window, 1) == $window });
is($ended ? $? : 'not', 0, 'Escape closes the window, status 0') or diag content("$root/error");
undef $window if $ended;

# ---- What moves by itself: only between two presses of the space bar ----
close $blocked;
unlink $saved;
$window = background("$root/out", "$root/error", "$root/build/15-relief", qw(--scene shadow --technique parallax --size 200x150));
system(qw(timeout 15 xdotool search --sync --onlyvisible --name 15-relief mousemove 100 75)) == 0 or die;
my $lit = 'shadow-30-parallax';
sub lit { save($lit, @_) or return ''; return content("$saved/$lit.png") } # reading a PNG that was renamed into place
my ($still, $again) = (lit(), lit());
ok($still ne '' && $still eq $again, 'the light stands');
press('space');
ok(wait_for(sub { lit() ne $still }), 'space: it moves');
press('space');
my $stopped = lit();
ok($stopped ne $still && $stopped eq lit(), 'space again: it stands elsewhere');
press('Escape');
ok(wait_for(sub { waitpid($window, 1) == $window }), 'Escape closes the window') and undef $window;

done_testing();
