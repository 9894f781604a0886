// The page of a report: reads what the program put into it, and shows it by its kind.
import { element } from '../elements';
import { accuracyPage } from './accuracy';
import type { Report } from './data';
import { make } from './dom';
import { invariantsPage } from './invariants';
import { planPage } from './plan';
import { stabilityPage } from './stability';
import { throughputPage } from './throughput';

const PAGES: Record<string, (report: Report<any>) => void> = {
  accuracy: accuracyPage, stability: stabilityPage, invariants: invariantsPage, plan: planPage, throughput: throughputPage,
};

const data = document.getElementById('mw-report');
if (data === null) {
  element('main').append(make('p', { class: 'fail' }, 'There is no report in this page. Create one with `manyworlds report`.'));
} else {
  try {
    const report = JSON.parse(data.textContent ?? '') as Report<unknown>;
    PAGES[report.report](report);
  } catch (error) {
    element('main').append(make('p', { class: 'fail' }, `This report cannot be shown completely. It may be from another version: ${error}`));
  }
}
