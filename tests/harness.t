#!/usr/bin/perl
# The hard cases' harness must fail where it should: it is run on tests/fixtures/harness, whose cases are named
# for what is right or wrong with them.
use strict;
use warnings;

my $tests = ($ENV{B} || "build") . "/tests";
my $table = "$tests/fixture.csv";
my @lines = `$tests/cases-harness $table`;
my $status = $? >> 8;
my $number = 0;

sub check {
    my ($good, $what) = @_;
    $number++;
    print $good ? "ok" : "not ok", " $number - $what\n";
}

check($status == 1, "a failure is exit status 1");
foreach (@lines) {
    my ($result, $case) = /^(ok|not ok) \d+ - (.*)/ or next;
    check(($result eq "ok") == ($case =~ /: good/), "'$case' is $result");
}
open(my $rows, "<", $table) or die "$table: $!";
check(<$rows> eq "lesson,function,case,float_value,double_value,error,bound,unit,pass\n", "the table's header");
while (<$rows>) {
    chomp;
    my @row = split(/,/, $_, -1);
    my $should = $row[2] =~ /^good flip/ ? "flip" : $row[2] =~ /^good/ ? "yes" : "no";
    check(@row == 9 && $row[8] eq $should, "$row[1], $row[2]: pass is $row[8]");
}
print "1..$number\n";
