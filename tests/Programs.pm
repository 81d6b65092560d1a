# What tests of programs share: files as bytes, and commands run with their outputs in files.
package Programs;
use strict;
use warnings;
use Exporter 'import';
use File::Temp 'tempdir';

our @EXPORT = qw(slurp spew start run);
my $tmp = tempdir(CLEANUP => 1);

sub slurp { # a file's bytes, or undef
    my ($path) = @_;
    open my $file, '<:raw', $path or return undef;
    local $/;
    return scalar <$file>;
}

sub spew { # writes a file; returns its path
    my ($path, $bytes) = @_;
    open my $file, '>:raw', $path or die "$path: $!";
    print $file $bytes;
    close $file or die "$path: $!";
    return $path;
}

sub start { # a command, its outputs in files; returns its process
    my $pid = fork // die "fork: $!";
    return $pid if $pid;
    open STDOUT, '>', "$tmp/out" or die;
    open STDERR, '>', "$tmp/err" or die;
    exec @_ or exit 127;
}

sub run { # a command; returns its status, standard output and standard error
    waitpid start(@_), 0;
    return ($? & 127 ? 'signal ' . ($? & 127) : $? >> 8, slurp("$tmp/out"), slurp("$tmp/err"));
}

1;
